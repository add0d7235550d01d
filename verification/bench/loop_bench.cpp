/// The kernel's process, with a note of when each tick began; stands in for interlock-kernel in a whole
/// robot.
///
/// Takes the command line of interlock-kernel, and from the environment INTERLOCK_BENCH_SETUP (`shipped` or
/// `before`), INTERLOCK_BENCH_SECONDS (of memory for notes) and INTERLOCK_BENCH_NOTES (a path). At the end
/// PATH.main, and for `before` PATH.bus, hold four native 64-bit words a tick, in ns: CLOCK_MONOTONIC at
/// which it began, how long after its deadline, when the transaction before was over, and how long after its
/// own transaction the tick was (of PATH.main: requests read, step, snapshot).
///
/// - `shipped` is the executive as it is: one loop, SCHED_FIFO, memory locked, on the core asked for. Its
///   deadlines fall on whole periods of CLOCK_MONOTONIC, so that cyclictest can be put between them.
/// - `before` is how the thesis began: the bus in a thread of its own, every 700 us, the loop in another,
/// both
///   SCHED_RR at one priority, on any core, nothing locked. They share their newest words behind a mutex.

#include <pthread.h>
#include <sched.h>
#include <signal.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "black_box.h"
#include "bus_sim.h"
#include "clock.h"
#include "config_file.h"
#include "link_server.h"
#include "link_socket.h"
#include "loop.h"
#include "options.h"
#include "realtime.h"

namespace {

constexpr std::uint64_t kBusPeriodNs = 700'000;
constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

volatile sig_atomic_t stop_requested;

struct Note {
  std::uint64_t begun_ns;
  std::uint64_t late_ns;
  std::uint64_t busy_until_ns;
  std::uint64_t work_ns;
};

/// The notes of one loop; never allocates after it was made, and drops what it has no room for.
class Notes {
 public:
  Notes(std::uint64_t seconds, std::uint64_t period_ns) : period_ns_(period_ns) {
    notes_.reserve(seconds * kNsPerSecond / period_ns);
  }

  /// The loop's next deadline is one period after this one.
  void begin(std::uint64_t deadline_ns) { deadline_ns_ = deadline_ns; }

  /// A tick begins; its own deadline comes one period after `begin`'s or after the one before.
  void add(std::uint64_t now_ns) {
    const std::uint64_t due_ns = deadline_ns_ + period_ns_;
    const std::uint64_t late_ns = now_ns > due_ns ? now_ns - due_ns : 0;
    // As the executive: whole periods that passed are skipped.
    deadline_ns_ = due_ns + late_ns / period_ns_ * period_ns_;
    if (notes_.size() < notes_.capacity()) {
      notes_.push_back({now_ns, late_ns, busy_until_ns_, 0});
    }
  }

  /// The transaction of the newest tick is over.
  void end_transaction(std::uint64_t now_ns) { busy_until_ns_ = now_ns; }

  /// The newest tick itself is over; only the first call for a tick counts.
  void end(std::uint64_t now_ns) {
    if (!notes_.empty() && notes_.back().work_ns == 0) {
      notes_.back().work_ns = now_ns - busy_until_ns_;
    }
  }

  [[nodiscard]] std::uint64_t deadline_ns() const { return deadline_ns_; }

  [[nodiscard]] bool write(const std::string& path) const {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(notes_.data()),
               static_cast<std::streamsize>(notes_.size() * sizeof(Note)));
    return static_cast<bool>(file.flush());
  }

 private:
  std::uint64_t period_ns_;
  std::uint64_t deadline_ns_ = 0;
  std::uint64_t busy_until_ns_ = 0;
  std::vector<Note> notes_;
};

/// A bus that notes when the loop comes to it, which is the first thing that a tick does.
struct NotedBus {
  ilk_bus_t inner;
  Notes* notes;

  static bool transact(void* driver, std::uint32_t tick, const ilk_outputs_t* out, ilk_inputs_t* in) {
    auto& noted = *static_cast<NotedBus*>(driver);
    noted.notes->add(ilk_now_ns());
    const bool alive = noted.inner.transact(noted.inner.driver, tick, out, in);
    noted.notes->end_transaction(ilk_now_ns());
    return alive;
  }
};

/// A bus in a thread of its own: the loop finds what the thread read last.
class RelayedBus {
 public:
  RelayedBus(ilk_bus_t inner, Notes& notes) : inner_(inner), notes_(notes) {}

  void run() {
    ilk_outputs_t out{};
    ilk_inputs_t in{};
    notes_.begin(ilk_now_ns());
    for (std::uint32_t tick = 0; stop_requested == 0; ++tick) {
      ilk_sleep_until(notes_.deadline_ns() + kBusPeriodNs);
      notes_.add(ilk_now_ns());
      {
        const std::scoped_lock lock(mutex_);
        out = out_;
      }
      const bool alive = inner_.transact(inner_.driver, tick, &out, &in);
      notes_.end_transaction(ilk_now_ns());
      const std::scoped_lock lock(mutex_);
      in_ = in;
      alive_ = alive;
    }
  }

  static bool transact(void* driver, std::uint32_t /*tick*/, const ilk_outputs_t* out, ilk_inputs_t* in) {
    auto& relayed = *static_cast<RelayedBus*>(driver);
    const std::scoped_lock lock(relayed.mutex_);
    relayed.out_ = *out;
    const ilk_inputs_t before = *in;
    *in = relayed.in_;
    in->link_generation = before.link_generation;
    in->deadlines_missed = before.deadlines_missed;
    return relayed.alive_;
  }

 private:
  ilk_bus_t inner_;
  Notes& notes_;
  std::mutex mutex_;
  ilk_outputs_t out_{};
  ilk_inputs_t in_{};
  bool alive_ = true;
};

/// Everything that a run needs; static, as in interlock-kernel.
struct Process {
  ilk_options_t options{};
  ilk_config_t config{};
  ilk_bus_sim_t bus{};
  ilk_link_server_t server{};
  ilk_link_socket_t link{};
  ilk_black_box_t black_box{};
  ilk_loop_t loop{};
  std::uint64_t seconds = 0;
  std::string notes;
};
Process process;

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

int fail(std::string_view what) {
  std::cerr << "loop_bench: " << what << '\n';
  return EXIT_FAILURE;
}

bool take_round_robin(int priority) {
  const sched_param parameters{.sched_priority = priority};
  return pthread_setschedparam(pthread_self(), SCHED_RR, &parameters) == 0;
}

void begin_loop(ilk_bus_t bus, std::uint32_t granted) {
  const ilk_run_terms_t terms{.clock = ILK_CLOCK_REAL, .speed = 1.0, .degraded = true, .granted = granted};
  ilk_loop_init(&process.loop, &process.config, &terms, bus, &process.server.mailbox, &stop_requested);
  if (process.options.black_box_path != nullptr) {
    ilk_loop_record(&process.loop, &process.black_box);
  }
  process.loop.ticker.deadline_ns -= process.loop.ticker.deadline_ns % process.loop.ticker.period_ns;
}

void run_ready(Notes& notes) {
  std::cout << "ready link=" << process.options.link_path << std::endl;
  notes.begin(process.loop.ticker.deadline_ns);
  while (stop_requested == 0) {
    ilk_loop_tick(&process.loop);
    notes.end(ilk_now_ns());
  }
}

int run_shipped() {
  Notes main(process.seconds, process.config.common.period_us * 1000ull);
  NotedBus bus{ilk_bus_sim_driver(&process.bus), &main};
  ilk_realtime_t realtime;
  ilk_realtime_acquire(&realtime, ILK_CLOCK_REAL, process.options.core, process.options.priority);
  if (realtime.granted != realtime.asked) {
    return fail("real-time rights were refused; run it with CAP_SYS_NICE and CAP_IPC_LOCK");
  }
  begin_loop({.driver = &bus, .simulated = true, .transact = NotedBus::transact}, realtime.granted);
  run_ready(main);
  return main.write(process.notes + ".main") ? EXIT_SUCCESS : fail("the notes cannot be written");
}

int run_before() {
  Notes main(process.seconds, process.config.common.period_us * 1000ull);
  Notes transactions(process.seconds, kBusPeriodNs);
  if (!take_round_robin(process.options.priority)) {
    return fail("SCHED_RR was refused; run it with CAP_SYS_NICE");
  }
  RelayedBus relayed(ilk_bus_sim_driver(&process.bus), transactions);
  NotedBus bus{{.driver = &relayed, .simulated = true, .transact = RelayedBus::transact}, &main};
  std::thread bus_thread([&relayed] { relayed.run(); });
  begin_loop({.driver = &bus, .simulated = true, .transact = NotedBus::transact}, 0);
  run_ready(main);
  bus_thread.join();
  return main.write(process.notes + ".main") && transactions.write(process.notes + ".bus")
             ? EXIT_SUCCESS
             : fail("the notes cannot be written");
}

/// Takes what can fail in the order of interlock-kernel, and gives it back.
int run(std::string_view setup) {
  ilk_error_t error;
  if (!ilk_config_load(process.options.config_path, &process.config, &error) ||
      ilk_link_listen(&process.link, process.options.link_path, &error) != ILK_LISTEN_OK ||
      !ilk_bus_sim_open(&process.bus, process.options.bus_path, ILK_CLOCK_REAL, &process.config,
                        &stop_requested, &error) ||
      !ilk_link_server_start(&process.server, process.link.descriptor, &error)) {
    return fail(error.text);
  }
  const ilk_black_box_terms_t terms{.config = &process.config,
                                    .clock = ILK_CLOCK_REAL,
                                    .simulated = true,
                                    .seconds = static_cast<std::uint32_t>(process.options.black_box_seconds)};
  if (process.options.black_box_path != nullptr &&
      !ilk_black_box_create(&process.black_box, &terms, &error)) {
    return fail(error.text);
  }
  const int code = setup == "shipped" ? run_shipped() : run_before();
  if (process.options.black_box_path != nullptr) {
    ilk_black_box_close(&process.black_box);
  }
  ilk_link_server_stop(&process.server, process.loop.attachment);
  ilk_bus_sim_close(&process.bus);
  ilk_link_unlisten(&process.link);
  return code;
}

}  // namespace

int main(int argc, char* argv[]) {
  const std::string setup = environment("INTERLOCK_BENCH_SETUP");
  process.notes = environment("INTERLOCK_BENCH_NOTES");
  process.seconds = std::strtoull(environment("INTERLOCK_BENCH_SECONDS").c_str(), nullptr, 10);
  if ((setup != "shipped" && setup != "before") || process.notes.empty() || process.seconds == 0) {
    return fail("INTERLOCK_BENCH_SETUP (shipped or before), _NOTES and _SECONDS are needed");
  }
  ilk_error_t error;
  if (ilk_options_parse(argc, argv, &process.options, &error) != ILK_OPTIONS_RUN ||
      process.options.clock != ILK_CLOCK_REAL) {
    return fail("expected the command line of interlock-kernel, on the real clock");
  }
  struct sigaction action{};
  action.sa_handler = [](int) { stop_requested = 1; };
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  return run(setup);
}
