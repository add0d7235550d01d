/// Times what the black box adds to a tick, and prints one JSON object.
///
/// A kernel runs in the random world of the target rung (nine cards, up to five requests a tick); only the
/// recording is inside the clock. The ring is that of a real run, so that its memory is as cold as there.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "black_box.h"
#include "interlock/kernel.h"

extern "C" {
#include "world.h"
}

namespace {

constexpr std::uint32_t kTicks = 200'000;
constexpr std::uint32_t kSeconds = 60;

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
  ilk_black_box_note(&run.box, run.state.tick, &run.state, &run.in, run.requests, count, &run.out);
  return static_cast<std::uint64_t>((std::chrono::steady_clock::now() - begun).count());
}

/// Bytes that the ring took for the ticks, the openings of its blocks included.
double bytes_of(const ilk_black_box_t& box) {
  return (box.ring->head - 1.0) * ILK_BLOCK_BYTES + static_cast<double>(box.used) * sizeof(std::uint64_t);
}

}  // namespace

int main() {
  const std::filesystem::path ring = "/dev/shm/interlock-bench-" + std::to_string(getpid()) + ".ring";
  static Run run;
  world_config(&run.config);
  world_begin(&run.world, 1);
  ilk_init(&run.config, &run.state);
  const ilk_black_box_terms_t terms{&run.config, ILK_CLOCK_REAL, true, kSeconds};
  ilk_error_t error{};
  if (!ilk_black_box_create(&run.box, ring.c_str(), &terms, &error)) {
    std::cerr << error.text << '\n';
    return EXIT_FAILURE;
  }
  ilk_black_box_begin(&run.box, &run.state);
  std::vector<std::uint64_t> times;
  times.reserve(kTicks);
  for (std::uint32_t n = 0; n < kTicks; ++n) {
    times.push_back(timed_tick(run));
  }
  std::ranges::sort(times);
  std::cout << nlohmann::json{{"median_ns", times[kTicks / 2]},
                              {"p99_ns", times[kTicks / 100 * 99]},
                              {"bytes_a_tick", bytes_of(run.box) / kTicks},
                              {"ring_mib", run.box.bytes >> 20}}
                   .dump()
            << '\n';
  ilk_black_box_close(&run.box);
  std::filesystem::remove(ring);
}
