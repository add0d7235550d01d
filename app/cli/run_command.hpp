/**
 * @file
 * `interlock run`: a simulated robot, its kernel, the app and the console.
 */
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"

namespace interlock::cli {

/** Clock of the simulated robot's kernel. */
enum class ClockChoice {
  real,  /**< deadlines of the wall clock */
  paced, /**< simulated time that follows the wall clock and waits for a late host */
  sim    /**< simulated time, as fast as simulator and app allow */
};

/** What `interlock run` was asked for. */
struct RunOptions {
  std::string robot = "neuro";            /**< name or file */
  std::uint16_t port = 8080;              /**< 0: one that is free */
  std::string public_origin;              /**< of the console behind a proxy with TLS; empty: none */
  std::string trusted_proxy;              /**< address that the proxy connects from; empty: none */
  std::optional<std::uint16_t> igtl_port; /**< for OpenIGTLink, in place of the robot file's */
  std::string igtl_dialect;               /**< in place of the robot file's, unless empty */
  ClockChoice clock = ClockChoice::paced;
  std::optional<double> speed;       /**< paced clock: multiple of real time; default 1 */
  std::optional<std::uint32_t> seed; /**< of the simulated hardware */
  std::optional<std::uint32_t> core; /**< the kernel's alone; the other processes keep off it */
  std::filesystem::path state;       /**< empty: the robot's directory under $XDG_STATE_HOME/interlock */
  std::filesystem::path sockets;     /**< empty: a private directory */
  std::filesystem::path plant;       /**< empty: models/plant/ROBOT.toml */
  std::filesystem::path web;         /**< empty: the console of the installation or the source tree */
  bool new_store = false;            /**< in the place of one that is missing or damaged */
  bool record = false;               /**< all of the run, not only the time around events */
  std::optional<std::uint32_t> black_box_s; /**< that the black box holds at least; default 60 */
};

/**
 * Checks everything that can be checked beforehand, starts the processes and runs until a signal or a
 * failure.
 *
 * Nothing is started when the robot is refused, the port is busy or another instance uses the state
 * directory. Each time that all is ready, a line "ready URL" follows in the output.
 */
Result<void> run(const RunOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
