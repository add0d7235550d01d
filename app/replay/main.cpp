/**
 * @file
 * interlock-player: takes the kernel's place on the link and shows a recording. The kernel core runs again on
 * each tick before it is shown; where it comes to something else, the player ends.
 */
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "build_info/build_info.hpp"
#include "interlock/replay.h"
#include "link_server.h"
#include "link_socket.h"
#include "replay/player.hpp"

namespace interlock {
namespace {

constexpr int exit_system = 1;
constexpr int exit_refused = 2;

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int /*signal*/) { stop_requested = 1; }

struct Options {
  std::string recording;
  std::string link_socket;
  double speed = 1.0;
};

void describe(CLI::App& cli, Options& options) {
  cli.set_version_flag("--version", std::string(version()) + " " + std::string(commit()));
  cli.add_option("--recording", options.recording, "recording to show (*.ilkr)")->required();
  cli.add_option("--link", options.link_socket, "socket on which an app looks for its kernel")->required();
  cli.add_option("--speed", options.speed, "multiple of the recorded pace")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
}

int complain(const std::string& what, int code) {
  std::cerr << "interlock-player: " << what << std::endl;
  return code;
}

void show_tick(void* player, const ilk_state_t* /*before*/, const ilk_recorded_tick_t* tick) {
  static_cast<Player*>(player)->show(*tick);
}

/** Shows everything, then the last tick until it is stopped. */
int play(ilk_recording_t& recording, Player& player) {
  player.wait_for_app();
  ilk_replay_report_t report{};
  ilk_replay_recording(&recording, &report, show_tick, &player);
  if (!ilk_replay_is_identical(&report)) {
    return complain("the recording is damaged, or the kernel comes to something else, after tick " +
                        std::to_string(report.replay.last_tick) + "; `interlock replay` says what",
                    exit_refused);
  }
  std::cout << "the recording ends at tick " << report.replay.last_tick << ", which stays in sight"
            << std::endl;
  player.hold();
  return 0;
}

int serve(const Options& options, ilk_recording_t& recording) {
  ilk_error_t error{};
  ilk_link_socket_t socket{};
  if (ilk_link_listen(&socket, options.link_socket.c_str(), &error) != ILK_LISTEN_OK) {
    return complain(error.text, exit_system);
  }
  int code = exit_system;
  const auto server = std::make_unique<ilk_link_server_t>();
  if (ilk_link_server_start(server.get(), socket.descriptor, &error)) {
    std::cout << "ready link=" << options.link_socket << std::endl;
    const auto player =
        std::make_unique<Player>(recording.header.run, options.speed, server->mailbox, stop_requested);
    code = play(recording, *player);
    ilk_link_server_stop(server.get(), player->attachment());
  } else {
    complain(error.text, exit_system);
  }
  ilk_link_unlisten(&socket);
  return code;
}

int run(const Options& options) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(options.recording.c_str(), "rbe"), std::fclose);
  const auto recording = std::make_unique<ilk_recording_t>();
  if (!file || ilk_recording_begin(recording.get(), file.get()) != ILK_HEADER_GOOD) {
    return complain(options.recording + " is no recording of this release; `interlock replay` says why",
                    exit_refused);
  }
  return serve(options, *recording);
}

}  // namespace
}  // namespace interlock

int main(int argc, char** argv) {
  // Without SA_RESTART, so that a signal ends the sleep for the next tick.
  struct sigaction action{};
  action.sa_handler = interlock::request_stop;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  interlock::Options options;
  CLI::App cli("Shows a recording in the kernel's place.", "interlock-player");
  interlock::describe(cli, options);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return cli.exit(error) == 0 ? 0 : interlock::exit_refused;
  }
  return interlock::run(options);
}
