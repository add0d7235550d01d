/**
 * @file
 * interlock-sim: the plant behind two sockets.
 */
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/socket.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iostream>
#include <memory>

#include "needle/scene.hpp"
#include "plant/parameters_file.hpp"
#include "plant/robot_file.hpp"
#include "plant/sim/control_server.hpp"

namespace {

using interlock::plant::Plant;
using interlock::plant::sim::BusServer;
using interlock::plant::sim::ControlServer;
using interlock::plant::sim::FileDescriptor;
using interlock::plant::sim::Listener;

constexpr int kExitFault = 2;

struct Options {
  std::string plant;
  std::string robot;
  std::string bus;
  std::string control;
  std::uint64_t seed = 1;
};

int fail(const std::string& reason) {
  std::cerr << "interlock-sim: " << reason << '\n';
  return kExitFault;
}

/** SIGINT and SIGTERM as something to poll, so that the sockets are always removed. */
FileDescriptor catch_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return FileDescriptor(::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
}

/** Serves until a signal ends it. The bus comes first in every round; each round is short. */
void serve(const FileDescriptor& end_signals, BusServer& bus, ControlServer& control) {
  constexpr timespec kNoWait{.tv_sec = 0, .tv_nsec = 0};
  constexpr timespec kHalfMillisecond{.tv_sec = 0, .tv_nsec = 500'000};
  std::vector<pollfd> descriptors;
  for (;;) {
    descriptors.assign(1, {.fd = end_signals.get(), .events = POLLIN, .revents = 0});
    bus.add_descriptors(descriptors);
    const std::size_t control_begin = descriptors.size();
    control.add_descriptors(descriptors);
    const timespec* wait = nullptr;
    if (control.has_work()) {
      wait = &kNoWait;
    } else if (bus.follows_wall_clock()) {
      wait = &kHalfMillisecond;
    }
    if (::ppoll(descriptors.data(), descriptors.size(), wait, nullptr) < 0 && errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "ppoll");
    }
    if (descriptors[0].revents != 0) {
      return;
    }
    const std::span<const pollfd> ready(descriptors);
    bus.serve(ready.subspan(1, control_begin - 1));
    control.serve(ready.subspan(control_begin));
  }
}

int run(const Options& options) {
  const auto robot = interlock::plant::load_robot(options.robot);
  if (!robot) {
    return fail(robot.error());
  }
  const auto parameters = interlock::plant::load_parameters(options.plant, *robot);
  if (!parameters) {
    return fail(parameters.error());
  }
  const FileDescriptor end_signals = catch_end_signals();
  auto bus_listener = Listener::open(options.bus, SOCK_SEQPACKET);
  if (!bus_listener) {
    return fail(bus_listener.error());
  }
  auto control_listener = Listener::open(options.control, SOCK_STREAM);
  if (!control_listener) {
    return fail(control_listener.error());
  }
  Plant plant(*robot, *parameters, options.seed);
  if (parameters->scene) {
    plant.surround(std::make_unique<interlock::needle::Scene>(*parameters->scene, options.seed));
  }
  BusServer bus(std::move(*bus_listener), plant, robot->crc);
  ControlServer control(std::move(*control_listener), plant, bus);
  std::cout << "ready bus=" << options.bus << " control=" << options.control << std::endl;
  serve(end_signals, bus, control);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The simulated robot: cards, axes, pedal and E-stop behind a bus socket and a control socket.",
               "interlock-sim");
  app.add_option("--plant", options.plant, "plant parameters (TOML)")->required();
  app.add_option("--robot", options.robot, "compiled robot file (*.ilkc)")->required();
  app.add_option("--bus", options.bus, "socket for the kernel")->required();
  app.add_option("--control", options.control, "socket for the bench")->required();
  app.add_option("--seed", options.seed, "seed of noise, bounce and bit errors")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitFault;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
