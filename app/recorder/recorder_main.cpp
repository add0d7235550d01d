/**
 * @file
 * interlock-recorder: keeps what the kernel's black box holds. A process of its own, so that neither the
 * kernel's nor the app's death takes the recording along, and none of them ever waits for a disk.
 */
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "build_info/build_info.hpp"
#include "recorder/audit_heads.hpp"
#include "recorder/recorder.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

/** Between two looks at the black box; a block takes a tenth of a second or more to fill. */
constexpr int look_interval_ms = 20;

/** For a disk that refuses the last ticks of a dead kernel, once this process was asked to end. */
constexpr std::chrono::seconds longest_end{20};

struct Options {
  fs::path socket;
  fs::path folder;
  fs::path audit_heads; /**< socket; empty: none */
  bool continuous = false;
  std::uint64_t keep_mib = 4096;
};

void say(const std::string& line) { std::cout << line << std::endl; }

/** The signals that ask to end, as a descriptor. */
FileDescriptor end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return FileDescriptor(signalfd(-1, &signals, SFD_CLOEXEC));
}

/** Waits for the next look; true when a signal asked to end. */
bool end_is_asked(const FileDescriptor& signals) {
  pollfd waiting{signals.get(), POLLIN, 0};
  signalfd_siginfo signal{};
  return poll(&waiting, 1, look_interval_ms) > 0 && read(signals.get(), &signal, sizeof signal) > 0;
}

/** The kernel that is followed, or one that died before all of it was on the disk. */
struct Followed {
  Followed(Ring black_box, const RecordingFolder& folder, const RecorderTerms& terms)
      : ring(std::move(black_box)), recorder(ring, folder, terms, say) {}

  Ring ring;
  Recorder recorder;
};

/** Follows one kernel after the other, and keeps the black boxes of dead ones until the disk takes them. */
class Service {
 public:
  Service(fs::path socket, const RecordingFolder& folder, RecorderTerms terms)
      : socket_(std::move(socket)), folder_(folder), terms_(std::move(terms)) {}

  /** The kernel that lives is followed from now on. */
  bool attach() {
    Recorded<Ring> ring = Ring::connect(socket_);
    if (ring) {
      followed_ = std::make_unique<Followed>(std::move(*ring), folder_, terms_);
    }
    return ring.has_value();
  }

  [[nodiscard]] const ilk_run_description_t* run() const {
    return followed_ ? &followed_->ring.run() : nullptr;
  }

  /** Looks at the kernel that is followed, or, with `attaches`, for one that is to be. */
  void step(bool attaches) {
    if (followed_ || (attaches && attach())) {
      const bool lives = followed_->ring.writer_lives();
      followed_->recorder.step();
      if (!lives) {
        finish_dead(std::move(followed_));
      }
    }
    if (!dead_.empty() && std::chrono::steady_clock::now() >= retry_at_) {
      retry();
    }
  }

  /** Asks the disk at once. */
  void hurry() { retry_at_ = {}; }

  /** What a dead kernel left is on the disk. */
  [[nodiscard]] bool is_done() const { return dead_.empty(); }

  /** Writes out what there is; the ticks of a living kernel are left to the next recorder. */
  void end() {
    if (followed_) {
      static_cast<void>(followed_->recorder.finish());
    }
    if (!is_done()) {
      say("the last ticks of " + std::to_string(dead_.size()) +
          " dead kernels are lost: the disk refused them");
    }
  }

 private:
  /** So many are kept: the first and the last of those that die while the disk is full. */
  static constexpr std::size_t most_dead = 4;

  void finish_dead(std::unique_ptr<Followed> dead) {
    if (dead->recorder.finish()) {
      return;
    }
    say("not all of this kernel's black box is on the disk; this recorder holds it until the disk takes it");
    if (dead_.size() == most_dead) {
      dead_.pop_back();
      say("the black box of a kernel before it is lost");
    }
    dead_.push_back(std::move(dead));
    retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  }

  void retry() {
    std::erase_if(dead_, [](const auto& dead) { return dead->recorder.finish(); });
    retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  }

  fs::path socket_;
  const RecordingFolder& folder_;
  RecorderTerms terms_;
  std::unique_ptr<Followed> followed_;
  std::vector<std::unique_ptr<Followed>> dead_;
  std::chrono::steady_clock::time_point retry_at_;
};

int record(const Options& options) {
  // A limit of file sizes is a disk that refuses, and whoever reads the output may die first: no reasons to
  // end.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  const pid_t parent = getppid();
  const FileDescriptor signals = end_signals();
  const Recorded<RecordingFolder> folder = RecordingFolder::open(options.folder, options.keep_mib << 20);
  if (!folder) {
    std::cerr << "interlock-recorder: " << folder.error() << std::endl;
    return 3;
  }
  std::optional<AuditHeads> heads;
  if (!options.audit_heads.empty()) {
    Recorded<AuditHeads> opened = AuditHeads::open(options.audit_heads, folder->path() / "audit-heads");
    if (!opened) {
      std::cerr << "interlock-recorder: " << opened.error() << std::endl;
      return 3;
    }
    heads.emplace(std::move(*opened));
  }
  RecorderTerms terms;
  terms.continuous = options.continuous;
  terms.build = std::string(version()) + ' ' + std::string(commit());
  Service service(options.socket, *folder, std::move(terms));
  service.attach();
  folder->finish_parts(service.run());
  say("ready recordings=" + folder->path().string());
  std::optional<std::chrono::steady_clock::time_point> until;
  const auto goes_on = [&] {
    // Whoever started kernel and recorder died, and the kernel is about to: its last tick counts, too.
    const bool awaits_kernels_end = getppid() != parent && service.run() != nullptr;
    return !until || awaits_kernels_end || (!service.is_done() && std::chrono::steady_clock::now() < *until);
  };
  while (goes_on()) {
    if (end_is_asked(signals)) {
      until = std::chrono::steady_clock::now() + longest_end;
      service.hurry();
    }
    service.step(!until);
    if (heads) {
      heads->step();
    }
  }
  if (heads) {
    heads->finish();
  }
  service.end();
  return 0;
}

int main(int argc, char** argv) {
  Options options;
  CLI::App cli("Keeps what the kernel's black box holds", "interlock-recorder");
  cli.add_option("--black-box", options.socket, "Socket on which the kernel hands out its black box")
      ->required();
  cli.add_option("--folder", options.folder, "Where the recordings go")->required();
  cli.add_option(
      "--audit-heads", options.audit_heads,
      "Socket on which the app reports the head of its audit, which is kept in FOLDER/audit-heads");
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
