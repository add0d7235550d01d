/**
 * @file
 * interlock-kernel: starts everything that can fail, says what was granted, then runs the loop.
 */
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "black_box.h"
#include "black_box_door.h"
#include "bus_sim.h"
#include "bus_spi.h"
#include "config_file.h"
#include "link_server.h"
#include "link_socket.h"
#include "loop.h"
#include "options.h"
#include "realtime.h"
#include "watchdog.h"

#define EXIT_ENDED 0
#define EXIT_SYSTEM 1
#define EXIT_REFUSED 2
#define EXIT_TAKEN 3

static volatile sig_atomic_t stop_requested;

/** Static: nothing that the loop uses is allocated, and its size is known at compile time. */
static ilk_config_t config;
static ilk_bus_sim_t sim_bus;
static ilk_bus_spi_t spi_bus;
static ilk_bus_t bus;
static ilk_link_server_t server;
static ilk_black_box_t black_box;
static ilk_loop_t loop;
static ilk_watchdog_t watchdog;

static void request_stop(int number) {
  (void)number;
  stop_requested = 1;
}

/** Without SA_RESTART, so that a signal ends the sleep for the next tick. */
static void catch_signals(void) {
  const struct sigaction action = {.sa_handler = request_stop};
  (void)sigaction(SIGTERM, &action, NULL);
  (void)sigaction(SIGINT, &action, NULL);
}

static int report_failure(const ilk_error_t *error, int code) {
  (void)fprintf(stderr, "interlock-kernel: %s\n", error->text);
  return code;
}

static void report_measures(const ilk_realtime_t *realtime) {
  for (uint32_t measure = 0; measure < ILK_RT_COUNT; ++measure) {
    const uint32_t bit = 1u << measure;
    const char *verdict = (realtime->granted & bit) != 0u ? "granted"
                          : (realtime->asked & bit) != 0u ? "refused: "
                                                          : "not asked for";
    const char *reason =
        (realtime->asked & ~realtime->granted & bit) != 0u ? strerror(realtime->refusal[measure]) : "";
    (void)printf("  %-20s %s%s\n", ilk_realtime_name((ilk_rt_measure_t)measure), verdict, reason);
  }
}

static void report_start(const ilk_options_t *options, const ilk_realtime_t *realtime,
                         ilk_run_permit_t permit) {
  (void)printf("interlock-kernel\n");
  (void)printf("  %-20s %u us\n", "period", config.common.period_us);
  if (options->clock == ILK_CLOCK_REAL) {
    (void)printf("  %-20s real%s\n", "clock",
                 permit == ILK_RUN_DEGRADED ? ", degraded: overruns are shown, not latched" : "");
  } else {
    (void)printf("  %-20s simulated, ", "clock");
    (void)(options->paced ? printf("paced at %g times real time\n", options->speed)
                          : printf("as fast as possible\n"));
  }
  (void)printf("  %-20s %s:%s, frames of %d words\n", "bus", options->bus == ILK_BUS_SPI ? "spi" : "sim",
               options->bus_path, ILK_FRAME_WORDS);
  (void)printf("  %-20s %s, CRC-32 0x%08x\n", "configuration", options->config_path, config.crc);
  report_measures(realtime);
  if (options->black_box_path != NULL) {
    (void)printf("  %-20s %s, %zu MiB for %d s\n", "black box", options->black_box_path,
                 black_box.bytes >> 20, options->black_box_seconds);
  }
  (void)printf("ready link=%s\n", options->link_path);
  (void)fflush(stdout);
}

/** Takes the rights, and runs the loop if they suffice. */
static int run_loop(const ilk_options_t *options) {
  ilk_realtime_t realtime;
  ilk_realtime_acquire(&realtime, options->clock, options->core, options->priority);
  const ilk_run_permit_t permit =
      ilk_realtime_permit(options->clock, bus.simulated, realtime.asked, realtime.granted);
  if (permit == ILK_REFUSE) {
    ilk_error_t error;
    (void)ilk_fail(&error,
                   "hardware needs the real clock, SCHED_FIFO and locked memory; grant CAP_SYS_NICE and "
                   "CAP_IPC_LOCK, or run as a service");
    return report_failure(&error, EXIT_REFUSED);
  }
  report_start(options, &realtime, permit);
  const ilk_run_terms_t terms = {.clock = options->clock,
                                 .speed = options->paced ? options->speed : 0.0,
                                 .degraded = permit == ILK_RUN_DEGRADED,
                                 .granted = realtime.granted};
  ilk_loop_init(&loop, &config, &terms, bus, &server.mailbox, &stop_requested);
  if (options->black_box_path != NULL) {
    ilk_loop_record(&loop, &black_box);
  }
  ilk_watchdog_ready(&watchdog);
  ilk_loop_run(&loop);
  return EXIT_ENDED;
}

/** Runs the loop with its black box. Its memory counts among what is to be locked, and its thread inherits no
 * real-time right, so both begin first. */
static int run_recorded(const ilk_options_t *options) {
  ilk_error_t error;
  ilk_black_box_door_t black_box_door;
  if (options->black_box_path == NULL) {
    return run_loop(options);
  }
  const ilk_black_box_terms_t terms = {.config = &config,
                                       .clock = options->clock,
                                       .simulated = bus.simulated,
                                       .seconds = (uint32_t)options->black_box_seconds};
  if (!ilk_black_box_create(&black_box, &terms, &error)) {
    return report_failure(&error, EXIT_REFUSED);
  }
  const ilk_listen_result_t listening =
      ilk_black_box_door_open(&black_box_door, options->black_box_path, &black_box, &error);
  if (listening != ILK_LISTEN_OK) {
    return report_failure(&error, listening == ILK_LISTEN_TAKEN ? EXIT_TAKEN : EXIT_REFUSED);
  }
  const int code = run_loop(options);
  ilk_black_box_door_close(&black_box_door);
  ilk_black_box_close(&black_box);
  return code;
}

static bool open_simulated(const ilk_options_t *options, ilk_error_t *error) {
  const bool opened =
      ilk_bus_sim_open(&sim_bus, options->bus_path, options->clock, &config, &stop_requested, error);
  bus = ilk_bus_sim_driver(&sim_bus);
  return opened;
}

static bool open_wired(const ilk_options_t *options, ilk_error_t *error) {
  ilk_spi_wiring_t wiring;
  const bool opened = ilk_spi_wiring_load(options->bus_path, &config, &wiring, error) &&
                      ilk_bus_spi_open(&spi_bus, &wiring, error);
  bus = ilk_bus_spi_driver(&spi_bus);
  return opened;
}

static void close_bus(void) {
  if (bus.simulated) {
    ilk_bus_sim_close(&sim_bus);
  } else {
    ilk_bus_spi_close(&spi_bus);
  }
}

/** Its thread begins before the real-time rights are taken, as those of bus and link do. */
static int run_watched(const ilk_options_t *options) {
  ilk_error_t error;
  const int code = ilk_watchdog_start(&watchdog, &loop.beats, &error) ? run_recorded(options)
                                                                      : report_failure(&error, EXIT_SYSTEM);
  ilk_watchdog_stop(&watchdog);
  return code;
}

static int run_with_link(const ilk_options_t *options, const ilk_link_socket_t *link) {
  ilk_error_t error;
  const bool opened =
      options->bus == ILK_BUS_SPI ? open_wired(options, &error) : open_simulated(options, &error);
  if (!opened) {
    return report_failure(&error, EXIT_REFUSED);
  }
  int code = EXIT_SYSTEM;
  if (ilk_link_server_start(&server, link->descriptor, &error)) {
    code = run_watched(options);
    ilk_link_server_stop(&server, loop.attachment);
  } else {
    (void)report_failure(&error, code);
  }
  close_bus();
  return code;
}

static int run(const ilk_options_t *options) {
  ilk_error_t error;
  ilk_link_socket_t link;
  if (!ilk_config_load(options->config_path, &config, &error)) {
    return report_failure(&error, EXIT_REFUSED);
  }
  const ilk_listen_result_t listening = ilk_link_listen(&link, options->link_path, &error);
  if (listening != ILK_LISTEN_OK) {
    return report_failure(&error, listening == ILK_LISTEN_TAKEN ? EXIT_TAKEN : EXIT_REFUSED);
  }
  if (options->link_shared && !ilk_link_share(&link, &error)) {
    ilk_link_unlisten(&link);
    return report_failure(&error, EXIT_REFUSED);
  }
  catch_signals();
  const int code = run_with_link(options, &link);
  ilk_link_unlisten(&link);
  return code;
}

int main(int argc, char *argv[]) {
  ilk_options_t options;
  ilk_error_t error;
  switch (ilk_options_parse(argc, argv, &options, &error)) {
    case ILK_OPTIONS_RUN:
      return run(&options);
    case ILK_OPTIONS_HELP:
      (void)fputs(ilk_options_help, stdout);
      return EXIT_ENDED;
    default:
      return report_failure(&error, EXIT_REFUSED);
  }
}
