/// Searches for the costliest step of the kernel and leaves what it found as cases for step_bench.
///
/// Usage: worst_path FOLDER SEED TRIES CASES: gathers from so many cases of the fault campaign, tries so many
/// changes in all, writes FOLDER/worst-1.json (the costliest) to worst-8.json, and prints what they are.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "step_search.hpp"

namespace {

using interlock::bench::Found;

constexpr std::size_t kStarts = 59; /**< beside the hand-written scenarios */
constexpr std::size_t kKept = 8;

nlohmann::json write(const std::filesystem::path& file, const Found& found) {
  const nlohmann::json about = {{"blocks", found.blocks},
                                {"start", found.start},
                                {"start_blocks", found.start_blocks},
                                {"requests", found.step.requests.size()},
                                {"mode_before", found.step.state.mode}};
  nlohmann::json whole = interlock::bench::json_of(found.step);
  whole["about"] = about;
  std::ofstream out(file);
  out << whole.dump() << "\n";
  if (!out.flush()) {
    std::cerr << file.string() << ": cannot be written\n";
    std::exit(1);
  }
  nlohmann::json told = about;
  told["file"] = file.string();
  return told;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: worst_path FOLDER SEED TRIES CASES\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  const std::uint64_t tries = std::strtoull(argv[3], nullptr, 10);
  interlock::bench::StepSearch search(seed);
  std::vector<Found> found = search.gather(std::strtoull(argv[4], nullptr, 10), kStarts);
  for (Found& each : found) {
    each = search.climb(each, tries / found.size());
  }
  std::ranges::stable_sort(found, std::ranges::greater{}, &Found::blocks);
  found.resize(std::min(found.size(), kKept));
  std::filesystem::create_directories(folder);
  nlohmann::json result = {{"seed", seed}, {"tries", tries}, {"found", nlohmann::json::array()}};
  for (std::size_t n = 0; n < found.size(); n++) {
    result["found"].push_back(write(folder / ("worst-" + std::to_string(n + 1) + ".json"), found[n]));
  }
  std::cout << result.dump() << "\n";
  return 0;
}
