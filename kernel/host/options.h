/**
 * @file
 * The command line of interlock-kernel.
 */
#ifndef INTERLOCK_HOST_OPTIONS_H
#define INTERLOCK_HOST_OPTIONS_H

#include "error.h"
#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How the motor cards are reached. */
typedef enum { ILK_BUS_SIM, ILK_BUS_SPI } ilk_bus_kind_t;

/** What the command line asked for. */
typedef struct {
  const char *config_path;
  ilk_bus_kind_t bus;
  const char *bus_path; /**< socket of the simulated bus, or wiring of the real one */
  const char *link_path;
  bool link_shared;           /**< with the kernel's group */
  const char *black_box_path; /**< NULL: nothing is recorded */
  int black_box_seconds;
  ilk_clock_t clock;
  bool paced;   /**< the simulated clock follows the wall's */
  double speed; /**< of the paced clock */
  int core;     /**< -1: any */
  int priority; /**< SCHED_FIFO, 1 to 99 */
} ilk_options_t;

/** What is to be done after reading the command line. */
typedef enum { ILK_OPTIONS_RUN, ILK_OPTIONS_HELP, ILK_OPTIONS_BAD } ilk_options_result_t;

/** Text for `--help`. */
extern const char *const ilk_options_help;

/** Reads the command line. When it is bad, `error` names the option, what was given and what was expected. */
ilk_options_result_t ilk_options_parse(int argc, char *const argv[], ilk_options_t *options,
                                       ilk_error_t *error);

#ifdef __cplusplus
}
#endif

#endif
