#include "publisher.h"

#include <stddef.h>

#include "atomic_words.h"
#include "futex.h"

_Static_assert((ILK_LINK_EVENTS & (ILK_LINK_EVENTS - 1u)) == 0u, "the ring's index wraps with its counter");

static void note_axis(ilk_axis_told_t *told, const ilk_axis_t *axis) {
  *told = (ilk_axis_told_t){.state = axis->state, .fault = axis->fault, .homed = axis->homed};
}

void ilk_publisher_init(ilk_publisher_t *publisher, const ilk_state_t *state) {
  *publisher = (ilk_publisher_t){.region = NULL, .mode = state->system.mode};
  for (uint32_t slot = 0; slot < (uint32_t)ILK_SLOTS; ++slot) {
    note_axis(&publisher->axis[slot], &state->axis[slot]);
  }
}

void ilk_publisher_attach(ilk_publisher_t *publisher, ilk_link_kernel_region_t *region) {
  publisher->region = region;
  publisher->lock = 0u;
  publisher->events = 0u;
}

static void put_event(ilk_publisher_t *publisher, const ilk_event_t *event) {
  ilk_link_kernel_region_t *region = publisher->region;
  if (region == NULL) {
    return;
  }
  ilk_event_t *shared = &region->event[publisher->events % ILK_LINK_EVENTS];
  __atomic_store_n(&shared->number, 0u, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  ilk_words_store(&shared->kind, &event->kind, (sizeof *event - sizeof event->number) / sizeof(uint32_t));
  publisher->events += 1u;
  __atomic_store_n(&shared->number, publisher->events, __ATOMIC_RELEASE);
  __atomic_store_n(&region->event_head, publisher->events, __ATOMIC_RELEASE);
}

static void put_verdicts(ilk_publisher_t *publisher, uint32_t tick, const ilk_outputs_t *out) {
  for (uint32_t i = 0; i < out->verdict_count && i < (uint32_t)ILK_REQUESTS_PER_TICK; ++i) {
    const ilk_verdict_record_t *verdict = &out->verdict[i];
    put_event(publisher,
              &(ilk_event_t){.kind = ILK_EVENT_VERDICT,
                             .tick = tick,
                             .value = {verdict->sequence, verdict->kind, verdict->axis, verdict->verdict}});
  }
}

static void put_mode_change(ilk_publisher_t *publisher, const ilk_state_t *state) {
  if (state->system.mode != publisher->mode) {
    put_event(publisher, &(ilk_event_t){.kind = ILK_EVENT_MODE,
                                        .tick = state->system.tick,
                                        .value = {publisher->mode, state->system.mode, state->system.cause,
                                                  state->system.cause_value}});
    publisher->mode = state->system.mode;
  }
}

static void put_axis_changes(ilk_publisher_t *publisher, uint32_t tick, uint32_t slot,
                             const ilk_axis_t *axis) {
  ilk_axis_told_t *told = &publisher->axis[slot];
  if (axis->fault != told->fault && axis->fault != (uint32_t)ILK_FAULT_NONE) {
    put_event(publisher, &(ilk_event_t){.kind = ILK_EVENT_FAULT,
                                        .tick = tick,
                                        .value = {slot, axis->fault, (uint32_t)axis->fault_value, 0u}});
  }
  if (axis->state != told->state || axis->homed != told->homed) {
    put_event(publisher, &(ilk_event_t){.kind = ILK_EVENT_AXIS,
                                        .tick = tick,
                                        .value = {slot, told->state, axis->state, axis->homed}});
  }
  note_axis(told, axis);
}

static void put_snapshot(ilk_publisher_t *publisher, const ilk_snapshot_t *snapshot) {
  ilk_link_kernel_region_t *region = publisher->region;
  __atomic_store_n(&region->snapshot_lock, publisher->lock + 1u, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  ilk_words_store((uint32_t *)&region->snapshot, (const uint32_t *)snapshot,
                  sizeof *snapshot / sizeof(uint32_t));
  publisher->lock += 2u;
  __atomic_store_n(&region->snapshot_lock, publisher->lock, __ATOMIC_RELEASE);
  ilk_futex_wake(&region->snapshot_lock, ILK_LINK_WAITERS);
}

void ilk_publisher_publish(ilk_publisher_t *publisher, const ilk_snapshot_t *snapshot,
                           const ilk_outputs_t *out, uint32_t request_tail) {
  const ilk_state_t *state = &snapshot->state;
  put_verdicts(publisher, state->system.tick, out);
  put_mode_change(publisher, state);
  for (uint32_t slot = 0; slot < (uint32_t)ILK_SLOTS; ++slot) {
    put_axis_changes(publisher, state->system.tick, slot, &state->axis[slot]);
  }
  if (publisher->region != NULL) {
    __atomic_store_n(&publisher->region->request_tail, request_tail, __ATOMIC_RELEASE);
    put_snapshot(publisher, snapshot);
  }
}
