/**
 * @file
 * The host's ring reader against an app that changes its region at any time: each read of shared memory gives
 * an arbitrary value. Work is bounded, nothing outside the ring is read, each word is read once, and what is
 * judged afterwards is the copy.
 */
#include "proof.h"

uint32_t read_shared(const uint32_t* place);

#define __atomic_load_n(place, order) read_shared(place)
#include "../../../kernel/host/ring_reader.c"

#define REQUEST_WORDS (sizeof(ilk_request_t) / sizeof(uint32_t))

static uint32_t reads;
static const uint32_t* head_place;
static uint32_t head;

/** One read of one request, arbitrarily chosen: what holds for it holds for all. */
static uint32_t chosen_request;
static uint32_t chosen_word;
static const uint32_t* chosen_place;
static uint32_t chosen_value;

uint32_t read_shared(const uint32_t* place) {
  uint32_t value;
  if (reads == 0u) {
    head_place = place;
    head = value;
  }
  if (reads == (1u + (chosen_request * REQUEST_WORDS) + chosen_word)) {
    chosen_place = place;
    chosen_value = value;
  }
  reads++;
  return value;
}

void harness(void) {
  ilk_link_app_region_t app;
  ilk_request_t requests[ILK_REQUESTS_PER_TICK];
  uint32_t tail;
  uint32_t dropped;
  uint32_t request;
  uint32_t word;
  GIVEN((request < ILK_REQUESTS_PER_TICK) && (word < REQUEST_WORDS));
  chosen_request = request;
  chosen_word = word;
  const uint32_t tail_before = tail;
  const uint32_t dropped_before = dropped;
  const uint32_t count = ilk_ring_read(&app, &tail, &dropped, requests);
  const uint32_t waiting = head - tail_before;
  const uint64_t all_dropped = (uint64_t)dropped_before + waiting;
  SHOW(head_place == &app.request_head, "link: the head is read first");
  SHOW(reads == (1u + (count * REQUEST_WORDS)), "link: and nothing more than the words of the requests");
  if (waiting > ILK_LINK_REQUESTS) {
    SHOW((count == 0u) && (tail == head), "link: a head beyond the ring is not believed");
    SHOW(dropped == ((all_dropped > UINT32_MAX) ? UINT32_MAX : (uint32_t)all_dropped),
         "link: what is skipped is counted");
  } else {
    SHOW(count == ((waiting < ILK_REQUESTS_PER_TICK) ? waiting : ILK_REQUESTS_PER_TICK),
         "link: as many as wait, but not more than a tick takes");
    SHOW((tail - tail_before) == count, "link: what was copied is consumed");
    SHOW(dropped == dropped_before, "link: nothing is skipped");
    if (request < count) {
      const uint32_t slot = (tail_before + request) & (ILK_LINK_REQUESTS - 1u);
      SHOW(chosen_place == (&app.request[slot].sequence + word),
           "link: each word of a waiting request is read once, in its order");
      SHOW(chosen_value == (&requests[request].sequence)[word], "link: what was read is what will be judged");
    }
  }
  GOAL(goal_full_tick, count == ILK_REQUESTS_PER_TICK);
  GOAL(goal_counter_wraps, (count == 3u) && (tail == 1u));
  GOAL(goal_liar, (count == 0u) && (dropped == UINT32_MAX) && (dropped_before != UINT32_MAX));
  GOAL(goal_nothing, (reads == 1u) && (waiting == 0u));
  GOAL(never_seventeen, count > ILK_REQUESTS_PER_TICK);
}
