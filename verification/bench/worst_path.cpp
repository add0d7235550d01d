/// Searches for the costliest step of the kernel and leaves what it found as cases for step_bench.
///
/// Usage: worst_path FOLDER SEED TRIES CASES: gathers from so many cases of the fault campaign, tries so many
/// changes in all, writes the costliest as FOLDER/worst-1.json to worst-8.json and what became of the
/// hand-written scenarios as worst-9.json and on, and prints what they are. Blocks are not all equally long,
/// so instructions are to be counted of each.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "step_scenarios.hpp"
#include "step_search.hpp"

namespace {

using interlock::bench::Found;

constexpr std::size_t kStarts = 59; /**< beside the hand-written scenarios */
constexpr std::ptrdiff_t kKept = 8;

nlohmann::json write(const std::filesystem::path& file, const Found& found) {
  const nlohmann::json about = {{"blocks", found.blocks},
                                {"start", found.start},
                                {"start_blocks", found.start_blocks},
                                {"requests", found.step.requests.size()},
                                {"mode_before", found.step.state.system.mode}};
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
  // The scenarios come last; they stay, whatever they cost.
  const auto scenarios = found.end() - static_cast<std::ptrdiff_t>(interlock::bench::kScenarios.size());
  std::stable_sort(found.begin(), scenarios,
                   [](const Found& one, const Found& other) { return one.blocks > other.blocks; });
  found.erase(std::min(found.begin() + kKept, scenarios), scenarios);
  std::filesystem::create_directories(folder);
  nlohmann::json result = {{"seed", seed}, {"tries", tries}, {"found", nlohmann::json::array()}};
  for (std::size_t n = 0; n < found.size(); n++) {
    result["found"].push_back(write(folder / ("worst-" + std::to_string(n + 1) + ".json"), found[n]));
  }
  std::cout << result.dump() << "\n";
  return 0;
}
