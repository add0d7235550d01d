#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_PRIORITY 80
#define LEAST_SPEED 0.001
#define MOST_SPEED 1000.0
#define DEFAULT_BLACK_BOX_SECONDS 60
#define MAX_BLACK_BOX_SECONDS 3600

const char *const ilk_options_help =
    "usage: interlock-kernel --config FILE.ilkc --bus sim:SOCKET|spi:FILE --link SOCKET\n"
    "                        [--link-shared] [--clock real|paced|sim] [--speed X] [--core N] [--priority N]\n"
    "                        [--black-box SOCKET] [--black-box-seconds N]\n"
    "\n"
    "  --config FILE    compiled robot configuration (interlock model compile)\n"
    "  --bus sim:PATH   card bus: the simulator that listens on that socket\n"
    "  --bus spi:FILE   card bus: the devices that the wiring names (docs/deployment.md)\n"
    "  --link PATH      socket to serve the app on\n"
    "  --link-shared    for the members of the kernel's group, too; else for its user alone\n"
    "  --clock CLOCK    real: wall-clock deadlines (default)\n"
    "                   paced: simulated time, which follows the wall clock and waits for a late host\n"
    "                   sim: simulated time, as fast as simulator and app allow\n"
    "  --speed X        paced clock: multiple of real time, 0.001 to 1000 (default 1)\n"
    "  --core N         run the loop on that core (default: any)\n"
    "  --priority N     SCHED_FIFO priority of the loop, 1 to 99 (default 80)\n"
    "  --black-box PATH record each tick in memory, and hand it out on that socket\n"
    "  --black-box-seconds N\n"
    "                   time that it holds, 1 to 3600 (default 60)\n"
    "\n"
    "exit codes: 0 ended by signal, 1 system failure, 2 refused to start, 3 link already served\n";

static bool parse_whole_number(const char *text, int least, int most, int *value) {
  char *end = NULL;
  errno = 0;
  const long number = strtol(text, &end, 10);
  if (errno != 0 || end == text || *end != '\0' || number < least || number > most) {
    return false;
  }
  *value = (int)number;
  return true;
}

static bool parse_speed(const char *text, double *speed) {
  char *end = NULL;
  errno = 0;
  const double number = strtod(text, &end);
  if (errno != 0 || end == text || *end != '\0' || !(number >= LEAST_SPEED && number <= MOST_SPEED)) {
    return false;
  }
  *speed = number;
  return true;
}

static bool parse_clock(const char *text, ilk_options_t *options) {
  options->clock = strcmp(text, "real") == 0 ? ILK_CLOCK_REAL : ILK_CLOCK_SIM;
  options->paced = strcmp(text, "paced") == 0;
  return options->clock == ILK_CLOCK_REAL || options->paced || strcmp(text, "sim") == 0;
}

static bool parse_bus(const char *text, ilk_options_t *options) {
  static const char sim[] = "sim:";
  static const char spi[] = "spi:";
  const size_t length = sizeof sim - 1u;
  const bool is_spi = strncmp(text, spi, length) == 0;
  const bool known = is_spi || strncmp(text, sim, length) == 0;
  options->bus = is_spi ? ILK_BUS_SPI : ILK_BUS_SIM;
  options->bus_path = &text[known ? length : strlen(text)];
  return *options->bus_path != '\0';
}

#define OPTION_CONFIG 1
#define OPTION_BUS 2
#define OPTION_LINK 3
#define OPTION_CLOCK 4
#define OPTION_SPEED 5
#define OPTION_CORE 6
#define OPTION_PRIORITY 7
#define OPTION_HELP 8
#define OPTION_BLACK_BOX 9
#define OPTION_BLACK_BOX_SECONDS 10
#define OPTION_LINK_SHARED 11

/** Returns NULL when the value was taken, otherwise what was expected. */
static const char *take_option(int option, const char *value, ilk_options_t *options) {
  switch (option) {
    case OPTION_CONFIG:
      options->config_path = value;
      return *value != '\0' ? NULL : "a file";
    case OPTION_BUS:
      return parse_bus(value, options) ? NULL : "sim:SOCKET or spi:FILE";
    case OPTION_LINK:
      options->link_path = value;
      return *value != '\0' ? NULL : "the path of a socket";
    case OPTION_LINK_SHARED:
      options->link_shared = true;
      return NULL;
    case OPTION_CLOCK:
      return parse_clock(value, options) ? NULL : "real, paced or sim";
    case OPTION_SPEED:
      return parse_speed(value, &options->speed) ? NULL : "a number from 0.001 to 1000";
    case OPTION_CORE:
      return parse_whole_number(value, 0, CPU_SETSIZE - 1, &options->core) ? NULL : "the number of a core";
    case OPTION_PRIORITY:
      return parse_whole_number(value, 1, 99, &options->priority) ? NULL : "a number from 1 to 99";
    case OPTION_BLACK_BOX:
      options->black_box_path = value;
      return *value != '\0' ? NULL : "the path of a socket";
    case OPTION_BLACK_BOX_SECONDS:
      return parse_whole_number(value, 1, MAX_BLACK_BOX_SECONDS, &options->black_box_seconds)
                 ? NULL
                 : "a number from 1 to 3600";
    default:
      return "a known option";
  }
}

static bool check_together(const ilk_options_t *options, bool speed_given, ilk_error_t *error) {
  const char *missing = options->config_path == NULL ? "--config FILE.ilkc"
                        : options->bus_path == NULL  ? "--bus sim:SOCKET or spi:FILE"
                        : options->link_path == NULL ? "--link SOCKET"
                                                     : NULL;
  if (missing != NULL) {
    return ilk_fail(error, "%s is missing; see --help", missing);
  }
  if (speed_given && !options->paced) {
    return ilk_fail(error, "--speed applies to the paced clock only; add --clock paced or leave it out");
  }
  return true;
}

static bool report_unusable(int option, const char *word, ilk_error_t *error) {
  if (option == (int)':') {
    return ilk_fail(error, "%s needs a value; see --help", word);
  }
  if (isgraph(optopt) != 0) {
    return ilk_fail(error, "-%c is not an option of interlock-kernel; see --help", optopt);
  }
  return ilk_fail(error, "%s is not an option of interlock-kernel; see --help", word);
}

ilk_options_result_t ilk_options_parse(int argc, char *const argv[], ilk_options_t *options,
                                       ilk_error_t *error) {
  static const struct option known_options[] = {
      {"config", required_argument, NULL, OPTION_CONFIG},
      {"bus", required_argument, NULL, OPTION_BUS},
      {"link", required_argument, NULL, OPTION_LINK},
      {"clock", required_argument, NULL, OPTION_CLOCK},
      {"speed", required_argument, NULL, OPTION_SPEED},
      {"core", required_argument, NULL, OPTION_CORE},
      {"priority", required_argument, NULL, OPTION_PRIORITY},
      {"help", no_argument, NULL, OPTION_HELP},
      {"black-box", required_argument, NULL, OPTION_BLACK_BOX},
      {"black-box-seconds", required_argument, NULL, OPTION_BLACK_BOX_SECONDS},
      {"link-shared", no_argument, NULL, OPTION_LINK_SHARED},
      {NULL, 0, NULL, 0}};
  *options = (ilk_options_t){.clock = ILK_CLOCK_REAL,
                             .speed = 1.0,
                             .core = -1,
                             .priority = DEFAULT_PRIORITY,
                             .black_box_seconds = DEFAULT_BLACK_BOX_SECONDS};
  bool speed_given = false;
  opterr = 0;
  optind = 0;
  for (;;) {
    const int option = getopt_long(argc, argv, "+:", known_options, NULL);
    if (option == -1) {
      break;
    }
    if (option == OPTION_HELP) {
      return ILK_OPTIONS_HELP;
    }
    if (option == (int)'?' || option == (int)':') {
      (void)report_unusable(option, argv[optind - 1], error);
      return ILK_OPTIONS_BAD;
    }
    const char *expected = take_option(option, optarg, options);
    if (expected != NULL) {
      (void)ilk_fail(error, "--%s is '%s'; expected %s", known_options[option - 1].name, optarg, expected);
      return ILK_OPTIONS_BAD;
    }
    speed_given = speed_given || option == OPTION_SPEED;
  }
  if (optind < argc) {
    (void)ilk_fail(error, "'%s' is not expected here; see --help", argv[optind]);
    return ILK_OPTIONS_BAD;
  }
  return check_together(options, speed_given, error) ? ILK_OPTIONS_RUN : ILK_OPTIONS_BAD;
}
