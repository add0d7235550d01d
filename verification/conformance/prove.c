/**
 * @file
 * For CBMC: one phase of the tick on every case that stands for a state of the model, whatever the rest of it
 * holds. Each column of the answer must be the table's, and nothing else may change. The assertions that
 * begin with "reach" must fail: each of them shows that an answer occurs. WITHOUT_GOALS leaves these out,
 * GOALS_ALONE leaves nothing else.
 */
#include "case.h"

#define CHECK(index, answer, name) __CPROVER_assert(out[index] == (answer), "column " name);
#define RELATION(holds, name) __CPROVER_assert(holds, "relation " name);
#define WITHIN(index, low, high) __CPROVER_assume(in[index] >= (low) && in[index] <= (high));
#define REACH(index, value, name) __CPROVER_assert(out[index] != (value), "reach " name);

int main(void) {
  case_t after;
  configure(&after);
  __CPROVER_assume(may_be(&after));
  const case_t before = after;
  const case_t* b = &before;
  const case_t* c = &after;
  int32_t in[INPUTS];
  int32_t out[OUTPUTS];
  (void)b;
  (void)c;
  read_inputs(b, b, in);
  WITHIN_ALL
#ifndef GOALS_ALONE
  __CPROVER_assert(has_row(in), "row for every input");
#endif
  call(&after);
  read_outputs(c, b, out);
#ifndef GOALS_ALONE
  CHECK_ALL
  RELATION_ALL
  __CPROVER_assert(keeps(c, b), "frame: nothing else changes");
#endif
#ifndef WITHOUT_GOALS
  REACH_ALL
#endif
  return 0;
}
