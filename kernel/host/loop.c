#include "loop.h"

#include <string.h>
#include <sys/random.h>

#include "histogram.h"
#include "interlock/kernel.h"
#include "ring_reader.h"

/** Ends the wait for an app that is frozen; long enough for one that a busy host keeps from running. */
#define APP_PATIENCE_MS 2000u

/** Another number at each start: no order from an earlier one can carry a consent of this. */
static uint32_t draw_nonce(void) {
  uint32_t nonce = 0u;
  if (getrandom(&nonce, sizeof nonce, GRND_NONBLOCK) != (ssize_t)sizeof nonce) {
    nonce = (uint32_t)ilk_now_ns();
  }
  return nonce;
}

void ilk_loop_init(ilk_loop_t *loop, const ilk_config_t *config, const ilk_run_terms_t *terms, ilk_bus_t bus,
                   ilk_link_mailbox_t *mailbox, const volatile sig_atomic_t *stop) {
  *loop = (ilk_loop_t){.config = config,
                       .bus = bus,
                       .mailbox = mailbox,
                       .stop = stop,
                       .bus_alive = true,
                       .shown = {.clock = terms->clock,
                                 .simulated = bus.simulated ? 1u : 0u,
                                 .degraded = terms->degraded ? 1u : 0u,
                                 .granted = terms->granted,
                                 .period_us = config->common.period_us,
                                 .config_crc = config->crc,
                                 .inputs = {.boot_nonce = draw_nonce()}}};
  (void)ilk_init(config, &loop->shown.state);
  ilk_publisher_init(&loop->publisher, &loop->shown.state);
  ilk_ticker_init(&loop->ticker, terms->clock, config->common.period_us, terms->speed, ilk_now_ns());
  if (terms->clock == ILK_CLOCK_SIM) {
    const uint64_t pace_ns = loop->ticker.pace_ns;
    loop->shown.pace_ns = pace_ns > UINT32_MAX ? UINT32_MAX : (uint32_t)pace_ns;
  }
}

void ilk_loop_record(ilk_loop_t *loop, ilk_black_box_t *black_box) {
  loop->black_box = black_box;
  ilk_black_box_begin(black_box, &loop->shown.state);
}

bool ilk_loop_is_missed(const ilk_loop_t *loop, uint64_t late_ns) {
  const uint64_t excused_ns = loop->bus.simulated ? loop->bus_ns : 0u;
  return loop->shown.degraded == 0u && late_ns > loop->ticker.period_ns + excused_ns;
}

static void note_lateness(ilk_loop_t *loop, uint64_t late_ns) {
  ilk_snapshot_t *shown = &loop->shown;
  const uint64_t missed = ilk_loop_is_missed(loop, late_ns) ? late_ns / loop->ticker.period_ns : 0u;
  shown->inputs.deadlines_missed = missed > UINT32_MAX ? UINT32_MAX : (uint32_t)missed;
  if (late_ns > loop->ticker.period_ns && shown->overruns < UINT32_MAX) {
    shown->overruns += 1u;
  }
  if (loop->ticker.clock == ILK_CLOCK_REAL) {
    ilk_timing_add(&shown->timing, ILK_PHASE_WAKE, late_ns);
  }
}

/** Nothing that moves is ever kept waiting for an app: neither hardware nor the real clock. */
static bool app_keeps_up(ilk_loop_t *loop) {
  return !loop->bus.simulated || loop->ticker.clock == ILK_CLOCK_REAL ||
         ilk_pacing_wait(&loop->pacing, loop->attachment, loop->shown.state.system.tick, APP_PATIENCE_MS,
                         loop->stop);
}

static void wait_for_tick(ilk_loop_t *loop) {
  const bool in_step = app_keeps_up(loop) && loop->bus_alive;
  const uint64_t now_ns = ilk_now_ns();
  const uint64_t deadline_ns = ilk_ticker_next(&loop->ticker, in_step, now_ns);
  ilk_lateness_add(&loop->lateness, &loop->shown.lateness, loop->ticker.waited_ns, now_ns);
  if (deadline_ns > now_ns) {
    ilk_sleep_until(deadline_ns);
  }
}

static void serve_newest_attachment(ilk_loop_t *loop) {
  ilk_attachment_t *attachment = ilk_mailbox_exchange(loop->mailbox, loop->attachment);
  if (attachment == loop->attachment) {
    return;
  }
  loop->attachment = attachment;
  loop->request_tail = 0u;
  loop->pacing = (ilk_pacing_t){0};
  ilk_publisher_attach(&loop->publisher, attachment != NULL ? attachment->regions.kernel : NULL);
  if (attachment != NULL) {
    loop->shown.inputs.link_generation = attachment->generation;
  }
}

static uint32_t read_requests(ilk_loop_t *loop) {
  if (!ilk_attachment_is_open(loop->attachment)) {
    return 0u;
  }
  return ilk_ring_read(loop->attachment->regions.app, &loop->request_tail, &loop->shown.requests_dropped,
                       loop->request);
}

/** Returns how many requests were judged. */
static uint32_t step(ilk_loop_t *loop) {
  ilk_snapshot_t *shown = &loop->shown;
  const uint32_t count = read_requests(loop);
  const uint32_t tick = shown->state.system.tick;
  ilk_step(loop->config, &shown->state, &shown->inputs, loop->request, count, &loop->out);
  if (shown->state.system.tick != tick + 1u) {
    loop->rebuilt = true;
  }
  return count;
}

static void publish_tick(ilk_loop_t *loop) {
  ilk_snapshot_t *shown = &loop->shown;
  (void)memcpy(shown->command, loop->out.command, sizeof shown->command);
  (void)memcpy(shown->gate, loop->out.gate, sizeof shown->gate);
  shown->power = loop->out.power;
  (void)memcpy(shown->lamp, loop->out.lamp, sizeof shown->lamp);
  ilk_publisher_publish(&loop->publisher, shown, &loop->out, loop->request_tail);
}

void ilk_loop_tick(ilk_loop_t *loop) {
  ilk_timing_t *timing = &loop->shown.timing;
  wait_for_tick(loop);
  if (*loop->stop != 0) {
    return;
  }
  (void)__atomic_add_fetch(&loop->beats, 1u, __ATOMIC_RELAXED);
  const uint64_t begun_ns = ilk_now_ns();
  if (loop->rebuilt) {
    loop->rebuilt = false;
    loop->shown.inputs.boot_nonce = draw_nonce();
  }
  note_lateness(loop, ilk_ticker_begin(&loop->ticker, begun_ns));
  serve_newest_attachment(loop);

  loop->bus_alive =
      loop->bus.transact(loop->bus.driver, loop->shown.state.system.tick, &loop->out, &loop->shown.inputs);
  const uint64_t transacted_ns = ilk_now_ns();
  loop->bus_ns = transacted_ns - begun_ns;
  ilk_timing_add(timing, ILK_PHASE_BUS, loop->bus_ns);

  const uint32_t requests = step(loop);
  const uint64_t stepped_ns = ilk_now_ns();
  ilk_timing_add(timing, ILK_PHASE_STEP, stepped_ns - transacted_ns);

  publish_tick(loop);
  if (loop->black_box != NULL) {
    ilk_black_box_note(loop->black_box, begun_ns, &loop->shown.state, &loop->shown.inputs, loop->request,
                       requests, &loop->out);
  }
  ilk_timing_add(timing, ILK_PHASE_PUBLISH, ilk_now_ns() - stepped_ns);
}

void ilk_loop_run(ilk_loop_t *loop) {
  while (*loop->stop == 0) {
    ilk_loop_tick(loop);
  }
}
