/**
 * @file
 * interlock-recorder: keeps what the kernel's black box holds. A process of its own, so that neither the
 * kernel's nor the app's death takes the recording along, and none of them ever waits for a disk.
 */
#include <poll.h>
#include <sys/signalfd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "build_info/build_info.hpp"
#include "recorder/recorder.hpp"
#include "recorder/rescue.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

/** Between two looks at the ring; a block takes a tenth of a second or more to fill. */
constexpr int look_interval_ms = 20;

struct Options {
  fs::path ring;
  fs::path folder;
  bool continuous = false;
  std::uint64_t keep_mib = 4096;
};

void say(const std::string& line) { std::cout << line << std::endl; }

/** The signals that ask to end, as a descriptor. */
FileHandle end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return FileHandle(signalfd(-1, &signals, SFD_CLOEXEC));
}

/** Waits for the next look; true when it is time to end. */
bool end_is_asked(const FileHandle& signals) {
  pollfd waiting{signals.get(), POLLIN, 0};
  return poll(&waiting, 1, look_interval_ms) > 0;
}

/** The ring of a kernel that lives; nothing while there is none. */
std::optional<Ring> live_ring(const fs::path& file) {
  Recorded<Ring> ring = Ring::open(file);
  return ring && ring->writer_lives() ? std::optional<Ring>(std::move(*ring)) : std::nullopt;
}

/** Follows one kernel; true when the recorder was asked to end before the kernel did. */
bool follow(Ring ring, const RecordingFolder& folder, const RecorderTerms& terms, const FileHandle& signals,
            Rescue& rescue) {
  Recorder recorder(ring, folder, terms, say);
  bool asked = false;
  bool lives = true;
  while (lives && !asked) {
    asked = end_is_asked(signals);
    lives = ring.writer_lives();
    recorder.step();
    rescue.look(&ring);
    rescue.step();
  }
  if (recorder.finish()) {
    if (!lives) {
      rescue.let_go(ring);
    }
  } else if (!lives) {
    say("not all of this kernel's black box is on the disk; it stays in memory until the disk takes it");
    rescue.take(std::move(ring));
  }
  return asked;
}

int record(const Options& options) {
  // A limit of file sizes is a disk that refuses, and no reason to end.
  std::signal(SIGXFSZ, SIG_IGN);
  const FileHandle signals = end_signals();
  const Recorded<RecordingFolder> folder = RecordingFolder::open(options.folder, options.keep_mib << 20);
  if (!folder) {
    std::cerr << "interlock-recorder: " << folder.error() << std::endl;
    return 3;
  }
  RecorderTerms terms;
  terms.continuous = options.continuous;
  terms.build = std::string(version()) + ' ' + std::string(commit());
  std::optional<Ring> going_on = live_ring(options.ring);
  folder->finish_parts(going_on ? &going_on->run() : nullptr);
  going_on.reset();
  // Before a kernel is started: it leaves what stands there a name, but of two rings only one.
  Rescue rescue(options.ring, *folder, terms.build, say);
  rescue.look();
  say("ready recordings=" + folder->path().string());
  while (!end_is_asked(signals)) {
    std::optional<Ring> ring = live_ring(options.ring);
    if (ring && follow(std::move(*ring), *folder, terms, signals, rescue)) {
      break;
    }
    rescue.look();
    rescue.step();
  }
  if (!rescue.is_done()) {
    say("what a dead kernel left is still in memory; the next start goes on with it");
  }
  return 0;
}

int main(int argc, char** argv) {
  Options options;
  CLI::App cli("Keeps what the kernel's black box holds", "interlock-recorder");
  cli.add_option("--black-box", options.ring, "File of the kernel's black box")->required();
  cli.add_option("--folder", options.folder, "Where the recordings go")->required();
  cli.add_flag("--continuous", options.continuous, "Record everything, not only the time around events");
  cli.add_option("--keep-mib", options.keep_mib,
                 "Finished recordings that are kept, MiB; the oldest go first")
      ->check(CLI::Range(1, 1 << 24))
      ->capture_default_str();
  CLI11_PARSE(cli, argc, argv);
  return record(options);
}

}  // namespace
}  // namespace interlock::recorder

int main(int argc, char** argv) { return interlock::recorder::main(argc, argv); }
