/// How the benches sum up the times of single calls.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace interlock::bench {

/// Median, tail and maximum of times in ns. The clock's own reading, some tens of ns, is in each of them.
inline nlohmann::json summary(std::vector<std::int64_t> times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  return {{"calls", times.size()},
          {"median_ns", at(0.5)},
          {"p99_ns", at(0.99)},
          {"p999_ns", at(0.999)},
          {"max_ns", times.back()}};
}

/// The time of one call, in ns.
template <typename Call>
std::int64_t time_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
}

}  // namespace interlock::bench
