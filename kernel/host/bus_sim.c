#include "bus_sim.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "clock.h"
#include "link_socket.h"
#include "service_thread.h"
#include "timespec.h"

#define NS_PER_MS 1000000u
/**
 * Real clock: a plant that dies is noticed at once, so this only bounds the wait for one that hangs. Long
 * enough for a plant that a busy machine keeps from running: its lateness is shown as overruns.
 */
#define REAL_PATIENCE_NS (200u * (uint64_t)NS_PER_MS)
/** Simulated clock: a late plant is a late host, so that only the end of the connection ends the wait. */
#define SIM_PATIENCE_NS UINT64_MAX
/** Longest sleep between looks at the connection and the stop flag. */
#define LOOK_INTERVAL_NS (50u * (uint64_t)NS_PER_MS)
#define RECONNECT_INTERVAL_MS 50
#define GREETING_PATIENCE_S 20
#define REGREETING_PATIENCE_S 2

static bool check_hello(const ilk_sim_hello_t *ours, const ilk_sim_hello_t *theirs, ilk_error_t *error) {
  if (theirs->magic != ours->magic || theirs->version != ours->version) {
    return ilk_fail(error, "the plant speaks bus version %u (magic 0x%08x); expected %u (0x%08x)",
                    theirs->version, theirs->magic, ours->version, ours->magic);
  }
  if (theirs->frame_words != ours->frame_words) {
    return ilk_fail(error, "the plant uses frames of %u words; expected %u", theirs->frame_words,
                    ours->frame_words);
  }
  if (theirs->period_us != ours->period_us || theirs->clock != ours->clock) {
    return ilk_fail(error, "the plant runs at %u us in clock %u; expected %u us in clock %u",
                    theirs->period_us, theirs->clock, ours->period_us, ours->clock);
  }
  return true;
}

static bool greet(int descriptor, const ilk_sim_hello_t *hello, time_t patience_s, ilk_error_t *error) {
  const struct timeval patience = {.tv_sec = patience_s};
  ilk_sim_hello_t answer;
  (void)setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  if (send(descriptor, hello, sizeof *hello, MSG_NOSIGNAL) != (ssize_t)sizeof *hello) {
    return ilk_fail(error, "cannot greet the plant: %s", strerror(errno));
  }
  const ssize_t received = recv(descriptor, &answer, sizeof answer, 0);
  if (received < 0) {
    return ilk_fail(error, "the plant did not answer the greeting: %s", strerror(errno));
  }
  if (received == 0) {
    return ilk_fail(
        error,
        "the plant refused the greeting (bus version %u, %u frame words, %u us, clock %u); see its log",
        hello->version, hello->frame_words, hello->period_us, hello->clock);
  }
  if (received != (ssize_t)sizeof answer) {
    return ilk_fail(error, "the plant's greeting has %zd bytes; expected %zu", received, sizeof answer);
  }
  return check_hello(hello, &answer, error);
}

/** Returns a connected descriptor, or -1 with the reason. */
static int connect_plant(const ilk_bus_sim_t *sim, time_t patience_s, ilk_error_t *error) {
  const int descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (descriptor < 0) {
    (void)ilk_fail(error, "cannot create the bus socket: %s", strerror(errno));
    return -1;
  }
  if (connect(descriptor, (const struct sockaddr *)&sim->address, sizeof sim->address) != 0) {
    (void)ilk_fail(error, "cannot connect to the plant at '%s': %s; start interlock-sim first",
                   sim->address.sun_path, strerror(errno));
  } else if (greet(descriptor, &sim->hello, patience_s, error)) {
    return descriptor;
  } else {
    /* `greet` has given the reason. */
  }
  (void)close(descriptor);
  return -1;
}

static bool stop_within(const ilk_bus_sim_t *sim, int timeout_ms) {
  struct pollfd stop = {.fd = sim->stop, .events = POLLIN};
  return poll(&stop, 1, timeout_ms) > 0;
}

/** `dup3` swaps in one step, so the loop sees the old connection or the new one, never none. */
static void swap_in(ilk_bus_sim_t *sim, int connected) {
  (void)dup3(connected, sim->descriptor, O_CLOEXEC);
  (void)close(connected);
  (void)__atomic_add_fetch(&sim->connections, 1u, __ATOMIC_RELEASE);
}

static bool reconnect(ilk_bus_sim_t *sim) {
  ilk_error_t error;
  int connected = connect_plant(sim, REGREETING_PATIENCE_S, &error);
  (void)fprintf(stderr, "bus: the plant went away%s%s\n", connected < 0 ? ": " : "",
                connected < 0 ? error.text : "");
  while (connected < 0) {
    if (stop_within(sim, RECONNECT_INTERVAL_MS)) {
      return false;
    }
    connected = connect_plant(sim, REGREETING_PATIENCE_S, &error);
  }
  swap_in(sim, connected);
  (void)fprintf(stderr, "bus: connected to the plant again\n");
  return true;
}

static void *watch(void *argument) {
  ilk_bus_sim_t *sim = argument;
  for (;;) {
    struct pollfd events[2] = {{.fd = sim->stop, .events = POLLIN},
                               {.fd = sim->descriptor, .events = POLLRDHUP}};
    (void)poll(events, 2, -1);
    if (events[0].revents != 0 || (events[1].revents != 0 && !reconnect(sim))) {
      return NULL;
    }
  }
}

bool ilk_bus_sim_open(ilk_bus_sim_t *sim, const char *path, ilk_clock_t clock, const ilk_config_t *config,
                      const volatile sig_atomic_t *stopped, ilk_error_t *error) {
  *sim = (ilk_bus_sim_t){.patience_ns = clock == ILK_CLOCK_REAL ? REAL_PATIENCE_NS : SIM_PATIENCE_NS,
                         .period_ns = (uint64_t)config->common.period_us * 1000u,
                         .stopped = stopped,
                         .hello = {.magic = ILK_SIM_MAGIC,
                                   .version = ILK_SIM_VERSION,
                                   .frame_words = ILK_FRAME_WORDS,
                                   .period_us = config->common.period_us,
                                   .clock = clock,
                                   .config_crc = config->crc}};
  if (!ilk_unix_address(path, &sim->address, error)) {
    return false;
  }
  sim->descriptor = connect_plant(sim, GREETING_PATIENCE_S, error);
  if (sim->descriptor < 0) {
    return false;
  }
  sim->stop = eventfd(0, EFD_CLOEXEC);
  if (sim->stop < 0) {
    (void)close(sim->descriptor);
    return ilk_fail(error, "cannot create the bus watcher's stop event: %s", strerror(errno));
  }
  if (!ilk_service_thread_start(&sim->thread, watch, sim, error)) {
    (void)close(sim->stop);
    (void)close(sim->descriptor);
    return false;
  }
  return true;
}

void ilk_bus_sim_close(ilk_bus_sim_t *sim) {
  ilk_service_thread_stop(sim->thread, sim->stop);
  (void)close(sim->descriptor);
}

static bool has_new_connection(const ilk_bus_sim_t *sim) {
  return sim->loop_connection != __atomic_load_n(&sim->connections, __ATOMIC_ACQUIRE);
}

static void note_new_connection(ilk_bus_sim_t *sim) {
  if (has_new_connection(sim)) {
    sim->loop_connection = __atomic_load_n(&sim->connections, __ATOMIC_ACQUIRE);
    sim->awaiting_reply = false;
  }
}

/** Whether there is something to receive, or the end of the connection to see, within `patience_ns`. */
static bool becomes_readable(const ilk_bus_sim_t *sim, uint64_t patience_ns) {
  const struct timespec look = ilk_timespec(patience_ns < LOOK_INTERVAL_NS ? patience_ns : LOOK_INTERVAL_NS);
  const uint64_t begun_ns = ilk_now_ns();
  do {
    struct pollfd wanted = {.fd = sim->descriptor, .events = POLLIN};
    if (ppoll(&wanted, 1, &look, NULL) > 0) {
      return true;
    }
  } while (*sim->stopped == 0 && !has_new_connection(sim) && ilk_now_ns() - begun_ns < patience_ns);
  return false;
}

typedef enum { REPLY_NONE, REPLY_RECEIVED, REPLY_LOST } reply_result_t;

static reply_result_t receive_reply(ilk_bus_sim_t *sim, uint64_t patience_ns) {
  if (!becomes_readable(sim, patience_ns)) {
    return has_new_connection(sim) ? REPLY_LOST : REPLY_NONE;
  }
  const ssize_t received = recv(sim->descriptor, &sim->reply, sizeof sim->reply, MSG_DONTWAIT | MSG_TRUNC);
  if (received <= 0) {
    return REPLY_LOST;
  }
  sim->awaiting_reply = false;
  return received == (ssize_t)sizeof sim->reply ? REPLY_RECEIVED : REPLY_NONE;
}

static reply_result_t exchange(ilk_bus_sim_t *sim, uint32_t tick, const ilk_outputs_t *out) {
  sim->exchange.magic = ILK_SIM_MAGIC;
  sim->exchange.tick = tick;
  sim->exchange.power = out->power;
  (void)memcpy(sim->exchange.lamp, out->lamp, sizeof out->lamp);
  (void)memcpy(sim->exchange.frame, out->frame, sizeof out->frame);
  if (send(sim->descriptor, &sim->exchange, sizeof sim->exchange, MSG_DONTWAIT | MSG_NOSIGNAL) !=
      (ssize_t)sizeof sim->exchange) {
    return REPLY_LOST;
  }
  sim->awaiting_reply = true;
  const reply_result_t result = receive_reply(sim, sim->patience_ns);
  const bool sound = sim->reply.magic == ILK_SIM_MAGIC && sim->reply.tick == tick;
  return result == REPLY_RECEIVED && !sound ? REPLY_NONE : result;
}

/** A plant that did not answer gets no second exchange before its first reply, so replies cannot pile up. */
static reply_result_t exchange_in_step(ilk_bus_sim_t *sim, uint32_t tick, const ilk_outputs_t *out) {
  note_new_connection(sim);
  if (sim->awaiting_reply) {
    const reply_result_t stale = receive_reply(sim, sim->period_ns);
    if (sim->awaiting_reply) {
      return stale;
    }
  }
  return exchange(sim, tick, out);
}

static bool transact(void *driver, uint32_t tick, const ilk_outputs_t *out, ilk_inputs_t *in) {
  ilk_bus_sim_t *sim = driver;
  const reply_result_t result = exchange_in_step(sim, tick, out);
  in->transaction_done = 0u;
  in->frames_received = 0u;
  if (result == REPLY_RECEIVED) {
    in->transaction_done = 1u;
    in->frames_received = sim->reply.frames_received;
    in->pedal_no_closed = sim->reply.pedal_no_closed;
    in->pedal_nc_closed = sim->reply.pedal_nc_closed;
    in->estop_loop_closed = sim->reply.estop_loop_closed;
    (void)memcpy(in->frame, sim->reply.frame, sizeof in->frame);
  }
  return result != REPLY_LOST;
}

ilk_bus_t ilk_bus_sim_driver(ilk_bus_sim_t *sim) {
  return (ilk_bus_t){.driver = sim, .simulated = true, .transact = transact};
}
