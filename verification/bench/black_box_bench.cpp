/// Times what the black box adds to a tick, measures what a tick takes of it under the campaign's faults, and
/// prints one JSON object.
///
/// A kernel runs in the random world of the target rung (nine cards, up to five requests a tick); only the
/// recording is inside the clock. The memory is that of a real run, so that it is as cold as there.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "black_box.h"
#include "interlock/kernel.h"
#include "plan.hpp"
#include "world.hpp"

extern "C" {
#include "world.h"
}

namespace {

constexpr std::uint32_t kTicks = 200'000;
constexpr std::uint32_t kSeconds = 60;
constexpr std::uint64_t kCases = 200;

struct Run {
  ilk_config_t config{};
  ilk_state_t state{};
  ilk_inputs_t in{};
  ilk_outputs_t out{};
  ilk_request_t requests[ILK_REQUESTS_PER_TICK]{};
  world_t world{};
  ilk_black_box_t box{};
};

/// Nanoseconds of the recording of one tick.
std::uint64_t timed_tick(Run& run) {
  world_inputs(&run.world, &run.config, &run.state, &run.out, &run.in);
  const std::uint32_t count = world_requests(&run.world, &run.config, &run.state, run.requests);
  ilk_step(&run.config, &run.state, &run.in, run.requests, count, &run.out);
  const auto begun = std::chrono::steady_clock::now();
  ilk_black_box_note(&run.box, run.state.system.tick, &run.state, &run.in, run.requests, count, &run.out);
  return static_cast<std::uint64_t>((std::chrono::steady_clock::now() - begun).count());
}

/// Bytes that the black box took for the ticks, the openings of its blocks included.
double bytes_of(const ilk_black_box_t& box) {
  return (box.ring->head - 1.0) * ILK_BLOCK_BYTES + static_cast<double>(box.used) * sizeof(std::uint32_t);
}

void create(ilk_black_box_t& box, const ilk_config_t& config) {
  const ilk_black_box_terms_t terms{&config, ILK_CLOCK_REAL, true, kSeconds};
  ilk_error_t error{};
  if (!ilk_black_box_create(&box, &terms, &error)) {
    std::cerr << error.text << '\n';
    std::exit(EXIT_FAILURE);
  }
}

nlohmann::json time_of_a_tick() {
  static Run run;
  world_config(&run.config);
  world_begin(&run.world, 1);
  ilk_init(&run.config, &run.state);
  create(run.box, run.config);
  ilk_black_box_begin(&run.box, &run.state);
  std::vector<std::uint64_t> times;
  times.reserve(kTicks);
  for (std::uint32_t n = 0; n < kTicks; ++n) {
    times.push_back(timed_tick(run));
  }
  std::ranges::sort(times);
  nlohmann::json figures{{"median_ns", times[kTicks / 2]},
                         {"p99_ns", times[kTicks / 100 * 99]},
                         {"bytes_a_tick", bytes_of(run.box) / kTicks},
                         {"memory_mib", static_cast<double>(run.box.bytes) / (1U << 20)}};
  ilk_black_box_close(&run.box);
  return figures;
}

/// Bytes a tick of one case of the fault campaign.
double bytes_of_case(std::uint64_t number) {
  interlock::campaign::Case plan = interlock::campaign::make_case(1, number);
  const auto world = std::make_unique<interlock::campaign::World>(plan);
  const auto box = std::make_unique<ilk_black_box_t>();
  create(*box, world->config());
  ilk_black_box_begin(box.get(), &world->state());
  for (std::uint32_t tick = 0; tick < plan.ticks; ++tick) {
    static_cast<void>(world->step());
    // The kernel looks at no more in a tick; the executive leaves the rest to the next one.
    const std::size_t requests = std::min<std::size_t>(world->requests().size(), ILK_REQUESTS_PER_TICK);
    ilk_black_box_note(box.get(), tick, &world->state(), &world->inputs(), world->requests().data(),
                       static_cast<std::uint32_t>(requests), &world->outputs());
  }
  const double bytes = bytes_of(*box) / plan.ticks;
  ilk_black_box_close(box.get());
  return bytes;
}

/// Of the campaign's first cases: what decides how much memory a minute takes (ILK_BLACK_BOX_BYTES_A_TICK).
nlohmann::json campaign() {
  std::vector<double> bytes;
  for (std::uint64_t number = 0; number < kCases; ++number) {
    bytes.push_back(bytes_of_case(number));
  }
  std::ranges::sort(bytes);
  return {{"campaign_bytes_a_tick", bytes[kCases / 2]}, {"campaign_bytes_a_tick_most", bytes.back()}};
}

}  // namespace

int main() {
  nlohmann::json figures = time_of_a_tick();
  figures.update(campaign());
  std::cout << figures.dump() << '\n';
}
