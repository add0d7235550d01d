/// Times the kernel's executive in one process with plant and app, over the real link; prints one JSON
/// object.
///
/// Usage: executive_bench reaction-sim|reaction-real|latency|throughput CONFIG PLANT COUNT SEED
///        executive_bench rate CONFIG PLANT SECONDS SEED CORE PRIORITY
///
/// - reaction-*: COUNT times the foot leaves the pedal while an axis is driven, on the real clock at any
/// moment
///   between two ticks; how long until the first frame on the wire that commands no drive. Ticks count from
///   the transaction that first saw an open contact.
/// - latency: COUNT requests, each sent at any moment; how long until the app has read the kernel's verdict.
/// - throughput: how many requests a second are judged when the app keeps the ring full, the clock unpaced.
/// - rate: how many ticks, and how many of them began more than a period late.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "clock.h"
#include "config_file.h"
#include "link/link_client.hpp"
#include "link_server.h"
#include "link_socket.h"
#include "loop.h"
#include "monitors.h"
#include "plant/exchange.hpp"
#include "plant/parameters_file.hpp"
#include "plant/plant.hpp"
#include "plant/random.hpp"
#include "realtime.h"
#include "timing.hpp"

namespace {

namespace fs = std::filesystem;
using interlock::LinkClient;
using interlock::LinkWait;
using interlock::plant::Plant;
using interlock::plant::Random;

constexpr int kPriority = 80;
constexpr std::chrono::milliseconds kPatience{2000};
constexpr std::uint32_t kHeartbeatTicks = 10;
constexpr std::uint32_t kRetryTicks = 20;
constexpr std::uint32_t kPressTicks = 200; /**< within which a press moves the axis */
constexpr std::uint32_t kDrivenTicks = 3;  /**< before the foot leaves: the axis is well on its way */

[[noreturn]] void give_up(const std::string& what) {
  std::cerr << "executive_bench: " << what << '\n';
  std::exit(EXIT_FAILURE);
}

/// Waits for the next snapshot; an unpaced kernel may write faster than one can be read.
void wait_for_snapshot(LinkClient& client, ilk_snapshot_t& seen) {
  do {
    if (client.wait(kPatience) != LinkWait::snapshot) {
      give_up("the kernel shows nothing");
    }
  } while (!client.read_snapshot(seen));
}

/// One release of the pedal, as the bus saw it.
struct Reaction {
  std::uint64_t elapsed_ns; /**< from the contact's opening to the transaction that carried zero drive */
  std::uint32_t ticks;      /**< from the transaction that first saw it open */
};

/// The plant on the bus of the loop, and a foot that another thread moves.
class PlantBus {
 public:
  PlantBus(const ilk_config_t& config, const interlock::plant::Parameters& parameters, std::uint64_t seed)
      : plant_(config, parameters, seed) {}

  ilk_bus_t driver() { return {.driver = this, .simulated = true, .transact = transact}; }

  void press() {
    release_at_ns_ = kNever;
    pressed_ = true;
  }

  /// The foot leaves, and nothing is measured.
  void lift() { pressed_ = false; }

  /// The contacts open at that moment; `reaction` is there once the wire has answered.
  void release_at(std::uint64_t when_ns) {
    answered_ = false;
    release_at_ns_ = when_ns;
  }

  /// The foot has left, and the wire carries zero drive.
  [[nodiscard]] bool answered() const { return answered_; }

  /// Nothing when the wire carried zero drive before the foot had left, for another reason.
  [[nodiscard]] std::optional<Reaction> reaction() const { return reaction_; }

 private:
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  static bool transact(void* driver, std::uint32_t tick, const ilk_outputs_t* out, ilk_inputs_t* in) {
    static_cast<PlantBus*>(driver)->exchange(tick, *out, *in);
    return true;
  }

  void exchange(std::uint32_t tick, const ilk_outputs_t& out, ilk_inputs_t& in) {
    const std::uint64_t now_ns = ilk_now_ns();
    const std::uint32_t generation = in.link_generation;
    const std::uint32_t missed = in.deadlines_missed;
    in = interlock::plant::exchange(plant_, out, tick);
    in.link_generation = generation;
    in.deadlines_missed = missed;
    const std::uint64_t release_ns = release_at_ns_;
    const bool down = pressed_ && now_ns < release_ns;
    in.pedal_no_closed = down ? 1 : 0;
    in.pedal_nc_closed = down ? 0 : 1;
    if (pressed_ && !down) {
      follow_release(now_ns, release_ns, out);
    }
  }

  void follow_release(std::uint64_t now_ns, std::uint64_t release_ns, const ilk_outputs_t& out) {
    const bool driven =
        std::ranges::any_of(out.frame, [](const auto& frame) { return !judge_is_zero_drive(frame); });
    if (driven) {
      open_ticks_++;
      return;
    }
    reaction_ = open_ticks_ > 0 ? std::optional(Reaction{now_ns - release_ns, open_ticks_}) : std::nullopt;
    open_ticks_ = 0;
    pressed_ = false;
    answered_ = true;
  }

  Plant plant_;
  std::uint32_t open_ticks_ = 0;
  std::optional<Reaction> reaction_; /**< published by `answered_` */
  std::atomic<bool> pressed_ = false;
  std::atomic<bool> answered_ = false;
  std::atomic<std::uint64_t> release_at_ns_ = kNever;
};

/// The executive in a thread: the loop, its link and a bus.
class Executive {
 public:
  Executive(const ilk_config_t& config, ilk_bus_t bus, ilk_clock_t clock, int core, int priority)
      : config_(config),
        link_path_(fs::temp_directory_path() / ("bench-" + std::to_string(getpid()) + ".sock")) {
    ilk_error_t error;
    if (ilk_link_listen(&socket_, link_path_.c_str(), &error) != ILK_LISTEN_OK ||
        !ilk_link_server_start(&server_, socket_.descriptor, &error)) {
      give_up(error.text);
    }
    thread_ = std::thread([this, bus, clock, core, priority] { run(bus, clock, core, priority); });
  }

  Executive(const Executive&) = delete;
  Executive& operator=(const Executive&) = delete;

  ~Executive() { stop(); }

  /// Ends the loop; its counts can be read from then on.
  void stop() {
    if (thread_.joinable()) {
      stop_ = 1;
      thread_.join();
      ilk_link_server_stop(&server_, loop_.attachment);
      ilk_link_unlisten(&socket_);
    }
  }

  [[nodiscard]] const ilk_snapshot_t& shown() const { return loop_.shown; }

  LinkClient attach() {
    LinkClient client(link_path_.string());
    if (const auto attached = client.attach(kPatience); !attached) {
      give_up(attached.error().message());
    }
    return client;
  }

 private:
  void run(ilk_bus_t bus, ilk_clock_t clock, int core, int priority) {
    ilk_realtime_t realtime;
    ilk_realtime_acquire(&realtime, clock, core, priority);
    const ilk_run_terms_t terms{.clock = clock, .speed = 0.0, .degraded = true, .granted = realtime.granted};
    ilk_loop_init(&loop_, &config_, &terms, bus, &server_.mailbox, &stop_);
    ilk_loop_run(&loop_);
  }

  const ilk_config_t& config_;
  fs::path link_path_;
  ilk_link_socket_t socket_{};
  ilk_link_server_t server_{};
  ilk_loop_t loop_{};
  volatile sig_atomic_t stop_ = 0;
  std::thread thread_;
};

/// An app that keeps one axis moving while the pedal is held: the least that lets something be stopped.
class Mover {
 public:
  Mover(LinkClient& client, const ilk_config_t& config) : client_(client), config_(config) {
    const auto found =
        std::ranges::find_if(config.axis, [](const ilk_axis_config_t& axis) { return axis.max_drive != 0u; });
    slot_ = static_cast<std::uint32_t>(found - std::begin(config.axis));
  }

  /// Waits for the next snapshot and asks for what is due.
  void follow() {
    wait_for_snapshot(client_, seen_);
    const std::uint32_t tick = seen_.state.system.tick;
    if (tick - heartbeat_tick_ >= kHeartbeatTicks) {
      heartbeat_tick_ = tick;
      ask(ILK_REQUEST_HEARTBEAT);
    }
    prepare(tick);
    for (ilk_event_t event; client_.read_event(event);) {
    }
    client_.publish_seen(tick);
  }

  [[nodiscard]] bool may_press() const {
    return seen_.state.system.mode == ILK_MODE_READY && seen_.state.system.pedal_armed != 0u &&
           axis().state == ILK_AXIS_ENABLED;
  }

  [[nodiscard]] bool is_driven() const { return seen_.command[slot_].drive != 0u; }

 private:
  [[nodiscard]] const ilk_axis_t& axis() const { return seen_.state.axis[slot_]; }

  void prepare(std::uint32_t tick) {
    const std::uint32_t mode = seen_.state.system.mode;
    if (axis().state == ILK_AXIS_FAULTED) {
      give_up("the axis faulted: " + std::to_string(axis().fault));
    }
    if (mode == ILK_MODE_MOTION) {
      move(tick);
    } else if (tick - asked_tick_ >= kRetryTicks) {
      asked_tick_ = tick;
      unlock(mode);
    }
  }

  void unlock(std::uint32_t mode) {
    if (mode == ILK_MODE_LOCKED) {
      ask(ILK_REQUEST_RESET);
    } else if (axis().homed == 0u) {
      ask(ILK_REQUEST_SET_HOME);
    } else if (axis().state == ILK_AXIS_DISABLED) {
      ask(ILK_REQUEST_ENABLE);
    }
  }

  /// Away from where the axis is, to the farther side.
  void move(std::uint32_t tick) {
    if (axis().state == ILK_AXIS_MOVING && axis().lease_ticks > config_.common.lease_max_ticks / 2u) {
      return;
    }
    if (tick - asked_tick_ < 2u) {
      return;
    }
    asked_tick_ = tick;
    const ilk_axis_config_t& limits = config_.axis[slot_];
    const std::int32_t middle = (limits.min_counts + limits.max_counts) / 2;
    const std::int32_t away = axis().position_counts < middle ? limits.max_counts - limits.coast_counts
                                                              : limits.min_counts + limits.coast_counts;
    ilk_request_t wish{};
    wish.kind = ILK_REQUEST_MOVE;
    wish.axis = slot_;
    wish.target_counts = away;
    wish.drive = limits.max_drive;
    wish.lease_ticks = config_.common.lease_max_ticks;
    wish.consent = seen_.state.system.consent;
    send(wish);
  }

  void ask(ilk_request_kind_t kind) {
    ilk_request_t wish{};
    wish.kind = static_cast<std::uint32_t>(kind);
    wish.axis = slot_;
    wish.holder = 1;
    send(wish);
  }

  void send(const ilk_request_t& wish) {
    if (client_.send(wish) == 0u) {
      give_up("the ring of requests is full");
    }
  }

  LinkClient& client_;
  const ilk_config_t& config_;
  std::uint32_t slot_;
  std::uint32_t heartbeat_tick_ = 0;
  std::uint32_t asked_tick_ = 0;
  ilk_snapshot_t seen_{};
};

struct Task {
  ilk_config_t config{};
  interlock::plant::Parameters parameters;
  std::uint64_t count;
  std::uint64_t seed;
};

/// The foot is down and the axis on its way. A press that leads to nothing is tried anew: the machine may
/// have kept the app from its heartbeat, which ends motion until the foot has left.
void get_moving(Mover& mover, PlantBus& bus) {
  bool is_pressed = false;
  std::uint32_t pressed_ticks = 0;
  for (std::uint32_t driven = 0; driven < kDrivenTicks;) {
    mover.follow();
    driven = mover.is_driven() ? driven + 1 : 0;
    if (is_pressed && ++pressed_ticks > kPressTicks) {
      bus.lift();
      is_pressed = false;
    } else if (!is_pressed && mover.may_press()) {
      bus.press();
      is_pressed = true;
      pressed_ticks = 0;
    }
  }
}

nlohmann::json reactions(const Task& task, ilk_clock_t clock) {
  PlantBus bus(task.config, task.parameters, task.seed);
  Executive executive(task.config, bus.driver(), clock, -1, kPriority);
  LinkClient client = executive.attach();
  Mover mover(client, task.config);
  Random random(task.seed, 0);
  std::vector<std::int64_t> times;
  std::array<std::uint64_t, 4> by_ticks{};
  std::uint64_t stopped_otherwise = 0;
  while (times.size() < task.count) {
    get_moving(mover, bus);
    const std::uint32_t phase_ns =
        clock == ILK_CLOCK_REAL ? random.below(2u * 1000u * task.config.common.period_us) : 0u;
    bus.release_at(ilk_now_ns() + phase_ns);
    while (!bus.answered()) {
      mover.follow();
    }
    if (const std::optional<Reaction> seen = bus.reaction()) {
      times.push_back(static_cast<std::int64_t>(seen->elapsed_ns));
      by_ticks[std::min<std::size_t>(seen->ticks, by_ticks.size() - 1)]++;
    } else {
      stopped_otherwise++;
    }
  }
  executive.stop();
  nlohmann::json printed{{"edges", times.size()},
                         {"ticks", {{"1", by_ticks[1]}, {"2", by_ticks[2]}, {"more", by_ticks[3]}}},
                         {"stopped_otherwise", stopped_otherwise}};
  if (clock == ILK_CLOCK_REAL) {
    printed["time"] = interlock::bench::summary(std::move(times));
  }
  return printed;
}

void wait_for_verdict(LinkClient& client, std::uint32_t sequence) {
  ilk_snapshot_t seen;
  for (;;) {
    wait_for_snapshot(client, seen);
    for (ilk_event_t event; client.read_event(event);) {
      if (event.kind == ILK_EVENT_VERDICT && event.value[0] == sequence) {
        return;
      }
    }
  }
}

ilk_request_t heartbeat() {
  ilk_request_t wish{};
  wish.kind = ILK_REQUEST_HEARTBEAT;
  wish.holder = 1;
  return wish;
}

nlohmann::json latency(const Task& task) {
  PlantBus bus(task.config, task.parameters, task.seed);
  Executive executive(task.config, bus.driver(), ILK_CLOCK_REAL, -1, kPriority);
  LinkClient client = executive.attach();
  Random random(task.seed, 0);
  std::vector<std::int64_t> times;
  for (std::uint64_t n = 0; n < task.count; ++n) {
    ilk_sleep_until(ilk_now_ns() + random.below(1000u * task.config.common.period_us));
    times.push_back(interlock::bench::time_of([&] { wait_for_verdict(client, client.send(heartbeat())); }));
  }
  executive.stop();
  return interlock::bench::summary(std::move(times));
}

nlohmann::json throughput(const Task& task) {
  PlantBus bus(task.config, task.parameters, task.seed);
  Executive executive(task.config, bus.driver(), ILK_CLOCK_SIM, -1, kPriority);
  LinkClient client = executive.attach();
  ilk_snapshot_t seen{};
  std::uint64_t judged = 0;
  const std::int64_t spent_ns = interlock::bench::time_of([&] {
    while (judged < task.count) {
      while (client.send(heartbeat()) != 0u) {
      }
      wait_for_snapshot(client, seen);
      for (ilk_event_t event; client.read_event(event);) {
        judged += event.kind == ILK_EVENT_VERDICT ? 1 : 0;
      }
      client.publish_seen(seen.state.system.tick);
    }
  });
  executive.stop();
  const double seconds = static_cast<double>(spent_ns) * 1e-9;
  return {{"requests", judged},
          {"requests_per_s", static_cast<double>(judged) / seconds},
          {"ticks_per_s", static_cast<double>(executive.shown().state.system.tick) / seconds},
          {"events_lost", client.events_lost()}};
}

nlohmann::json rate(const Task& task, int core, int priority) {
  PlantBus bus(task.config, task.parameters, task.seed);
  Executive executive(task.config, bus.driver(), ILK_CLOCK_REAL, core, priority);
  std::this_thread::sleep_for(std::chrono::seconds(task.count));
  executive.stop();
  const ilk_snapshot_t& shown = executive.shown();
  return {{"period_us", task.config.common.period_us},
          {"ticks", shown.state.system.tick},
          {"missed", shown.overruns},
          {"wake_max_ns", shown.timing.max_ns[ILK_PHASE_WAKE]}};
}

nlohmann::json perform(std::string_view what, const Task& task, char** rest) {
  if (what == "reaction-sim" || what == "reaction-real") {
    return reactions(task, what == "reaction-sim" ? ILK_CLOCK_SIM : ILK_CLOCK_REAL);
  }
  if (what == "latency") {
    return latency(task);
  }
  return what == "throughput" ? throughput(task) : rate(task, std::atoi(rest[0]), std::atoi(rest[1]));
}

}  // namespace

int main(int argc, char** argv) {
  constexpr std::array kTasks{"reaction-sim", "reaction-real", "latency", "throughput", "rate"};
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (std::ranges::find(kTasks, what) == kTasks.end() || argc != (what == "rate" ? 8 : 6)) {
    give_up("expected TASK CONFIG PLANT COUNT SEED; for rate CORE PRIORITY, too");
  }
  Task task;
  ilk_error_t error;
  if (!ilk_config_load(argv[2], &task.config, &error)) {
    give_up(error.text);
  }
  const auto parameters = interlock::plant::load_parameters(argv[3], task.config);
  if (!parameters) {
    give_up(parameters.error());
  }
  task.parameters = *parameters;
  task.count = std::strtoull(argv[4], nullptr, 10);
  task.seed = std::strtoull(argv[5], nullptr, 10);
  std::cout << perform(what, task, argv + 6).dump() << '\n';
}
