/**
 * @file
 * What no request of a tick fills of its verdicts says nothing; what is filled stays.
 */
#include "proof.h"
#include "step.c"

void harness(void) {
  ilk_outputs_t out;
  uint32_t index;
  GIVEN((out.verdict_count <= ILK_REQUESTS_PER_TICK) && (index < ILK_REQUESTS_PER_TICK));
  const uint32_t count = out.verdict_count;
  const ilk_verdict_record_t before = out.verdict[index];
  clear_unused_verdicts(&out);
  const ilk_verdict_record_t after = out.verdict[index];
  const bool used = index < count;
  SHOW(out.verdict_count == count, "P11: the number of verdicts stays");
  SHOW((after.tick == (used ? before.tick : 0u)) && (after.sequence == (used ? before.sequence : 0u)) &&
           (after.kind == (used ? before.kind : 0u)) && (after.axis == (used ? before.axis : 0u)) &&
           (after.verdict == (used ? before.verdict : 0u)),
       "P11: a verdict that was given stays; what is not used is zero");
  GOAL(goal_all_used, (count == 16u) && (after.sequence == 9u));
  GOAL(goal_none_used, (count == 0u) && (before.sequence == 9u));
  GOAL(never_more_than_sixteen, count > 16u);
}
