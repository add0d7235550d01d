/**
 * @file
 * Phase 6 for any number of requests up to sixteen, which is all that the step takes (proof `step`): each is
 * judged once, in order, by the state that the ones before it left; what is accepted is carried out, and
 * nothing else; each gets one verdict, and is counted.
 */
#include "axis_effects.h"
#include "counts.h"
#include "proof.h"
#include "step.c"

static ilk_config_t config;
static ilk_state_t state;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];

/** The verdicts that `ilk_request_judge` gives, and the modes that `ilk_request_apply` leaves. */
static uint32_t verdicts[ILK_REQUESTS_PER_TICK];
static uint32_t modes[ILK_REQUESTS_PER_TICK];

/** The request judged last: the verdict on it, and the counters as they were then. */
static struct {
  uint32_t verdict;
  uint32_t sequence;
  uint32_t last_sequence;
  uint32_t accepted;
  uint32_t refused;
  bool carried_out;
} last;
static uint32_t judged;
static uint32_t mode_left;

static uint32_t counted(uint32_t counter, bool counts) {
  return counts ? (uint32_t)one_more(counter, UINT32_MAX) : counter;
}

/** What became of the request judged last. */
static void show_last(void) {
  const bool accepted = last.verdict == ILK_VERDICT_ACCEPTED;
  const bool uses_number = (last.verdict != ILK_VERDICT_CHECKSUM) && (last.verdict != ILK_VERDICT_SEQUENCE);
  SHOW(last.carried_out == accepted, "P11: an accepted request is carried out before the next is judged");
  SHOW(state.requests_accepted == counted(last.accepted, accepted), "P11: accepted ones are counted");
  SHOW(state.requests_refused == counted(last.refused, !accepted), "P11: refused ones are counted");
  SHOW(state.last_sequence == (uses_number ? last.sequence : last.last_sequence),
       "P11: an intact request in order uses up its number");
}

ilk_verdict_t some_verdict(const ilk_config_t* used, const ilk_state_t* by, const ilk_request_t* request) {
  const uint32_t index = judged;
  SHOW((index < ILK_REQUESTS_PER_TICK) && (request == &requests[index]),
       "P11: requests are judged in their order");
  SHOW((used == &config) && (by == &state), "P11: by this state");
  GIVEN(index < ILK_REQUESTS_PER_TICK);
  if (index > 0u) {
    show_last();
  }
  last.verdict = verdicts[index];
  last.sequence = requests[index].sequence;
  last.last_sequence = state.last_sequence;
  last.accepted = state.requests_accepted;
  last.refused = state.requests_refused;
  last.carried_out = false;
  judged++;
  return (ilk_verdict_t)verdicts[index];
}

void some_effect(const ilk_config_t* used, ilk_state_t* changed, const ilk_request_t* request) {
  const uint32_t index = judged - 1u;
  SHOW((judged > 0u) && (request == &requests[index]), "P11: what was judged is carried out");
  SHOW(last.verdict == ILK_VERDICT_ACCEPTED, "P11: a refused request is not carried out");
  SHOW(!last.carried_out, "P11: a request is carried out once");
  SHOW((used == &config) && (changed == &state), "P11: in this state");
  last.carried_out = true;
  state.mode = modes[index];
  mode_left = modes[index];
}

static void show_record(uint32_t index) {
  const ilk_verdict_record_t* record = &out.verdict[index];
  const ilk_request_t* request = &requests[index];
  SHOW(record->verdict == verdicts[index], "P11: each request gets its verdict");
  SHOW((record->sequence == request->sequence) && (record->kind == request->kind) &&
           (record->axis == request->axis) && (record->tick == state.tick),
       "P11: a verdict names its request");
}

/** Nothing else of the state changes. */
static void show_rest(const ilk_state_t* before) {
  ilk_state_t wanted = *before;
  wanted.mode = mode_left;
  wanted.last_sequence = state.last_sequence;
  wanted.requests_accepted = state.requests_accepted;
  wanted.requests_refused = state.requests_refused;
  show_same_system(&state, &wanted);
}

static void answer_any(uint32_t count, uint32_t slot) {
  const ilk_state_t before = state;
  const ilk_axis_t axis_before = state.axis[slot];
  mode_left = state.mode;
  answer_requests(&config, &state, requests, count, &out);
  SHOW((out.verdict_count == count) && (judged == count), "P11: one verdict a request");
  if (judged > 0u) {
    show_last();
  }
  for (uint32_t index = 0u; index < ILK_REQUESTS_PER_TICK; index++) {
    if (index < count) {
      show_record(index);
    }
  }
  show_rest(&before);
  const ilk_axis_t axis_after = state.axis[slot];
  show_same_axis(&axis_after, &axis_before);
  GOAL(goal_sixteen, (count == 16u) && (out.verdict[15].verdict == ILK_VERDICT_ACCEPTED));
  GOAL(goal_none, out.verdict_count == 0u);
  GOAL(goal_bad_after_good, (count == 2u) && (state.last_sequence == requests[0].sequence) &&
                                (verdicts[1] == ILK_VERDICT_CHECKSUM) && (before.last_sequence == 5u) &&
                                (requests[0].sequence == 9u));
  GOAL(goal_saturated, (state.requests_refused == UINT32_MAX) && (before.requests_refused == UINT32_MAX) &&
                           (judged > 0u) && (last.verdict != ILK_VERDICT_ACCEPTED));
  GOAL(never_a_seventeenth_verdict, out.verdict_count > 16u);
}

void harness(void) {
  ilk_state_t any_state;
  ilk_outputs_t any_outputs;
  uint32_t count;
  uint32_t slot;
  GIVEN((slot < ILK_SLOTS) && (count <= ILK_REQUESTS_PER_TICK));
  state = any_state;
  out = any_outputs;
  for (uint32_t index = 0u; index < ILK_REQUESTS_PER_TICK; index++) {
    ilk_request_t request;
    uint32_t verdict;
    uint32_t mode;
    GIVEN(verdict < ILK_VERDICT_COUNT);
    requests[index] = request;
    verdicts[index] = verdict;
    modes[index] = mode;
  }
  answer_any(count, slot);
}
