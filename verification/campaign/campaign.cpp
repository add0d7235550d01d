/**
 * @file
 * kernel_campaign: runs cases one after the other and prints their totals as one line of JSON.
 *
 * Exit status 0: nothing was unsafe or late; 1: something was, and a case file says how to see it; 2: usage.
 */
#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "case_file.hpp"
#include "shrink.hpp"

namespace interlock::campaign {
namespace {

struct Choices {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t stride = 1;
  std::uint64_t cases = 0;
  double seconds = 0;
  std::filesystem::path failures = ".";
  std::filesystem::path replay;
  std::uint32_t trace = 0;
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <std::size_t bits>
std::string hex_of(const std::bitset<bits>& set) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (std::size_t bit = bits; bit >= 4; bit -= 4) {
    const unsigned digit = static_cast<unsigned>(set[bit - 1]) << 3 |
                           static_cast<unsigned>(set[bit - 2]) << 2 |
                           static_cast<unsigned>(set[bit - 3]) << 1 | static_cast<unsigned>(set[bit - 4]);
    text += digits[digit];
  }
  return text;
}

nlohmann::json json_of(const Totals& totals) {
  nlohmann::json kinds;
  for (std::size_t kind = 0; kind < kFaultKinds; kind++) {
    kinds[std::string(name_of(static_cast<FaultKind>(kind)))] = totals.faults_by_kind[kind];
  }
  return {{"ticks", totals.ticks},
          {"faults_injected", totals.faults_injected},
          {"unsafe", totals.unsafe},
          {"late", totals.late},
          {"bit_flips", totals.bit_flips},
          {"bit_flips_unsafe", totals.bit_flips_unsafe},
          {"stops_met", totals.stops_met},
          {"motion_ticks", totals.motion_ticks},
          {"driven_axis_ticks", totals.driven_axis_ticks},
          {"homings", totals.homings},
          {"moves_accepted", totals.moves_accepted},
          {"requests_refused", totals.requests_refused},
          {"configurations_refused", totals.configurations_refused},
          {"digest", totals.digest},
          {"faults_by_kind", kinds},
          {"axis_faults", totals.axis_faults},
          {"causes", totals.causes},
          {"kind_pairs", hex_of(totals.kind_pairs)},
          {"state_bits", hex_of(totals.state_bits)},
          {"config_bits", hex_of(totals.config_bits)},
          {"config_bits_driven", hex_of(totals.config_bits_driven)},
          {"estop_ticks", hex_of(totals.estop_ticks)},
          {"pedal_ticks", hex_of(totals.pedal_ticks)},
          {"sizes",
           {{"kind_pairs", kKindPairs},
            {"state_bits", kStateBits},
            {"config_bits", kConfigBits},
            {"estop_ticks", kMoveTicks},
            {"pedal_ticks", kMoveTicks}}}};
}

std::string text_of(const Failure& failure) {
  const std::string axis = failure.axis == kNoAxis ? "" : "axis " + std::to_string(failure.axis) + ", ";
  return "tick " + std::to_string(failure.tick) + ": " + std::string(failure.clause) + "; " + axis +
         "found " + std::to_string(failure.found) + ", bound " + std::to_string(failure.bound);
}

void report(const Choices& choices, const Case& plan, const Failure& failure) {
  std::cerr << "seed " << plan.seed << " case " << plan.number << " " << text_of(failure) << std::endl;
  const Case small = shrink(plan, failure);
  const std::filesystem::path file =
      choices.failures / ("case-" + std::to_string(plan.seed) + "-" + std::to_string(plan.number) + ".txt");
  std::filesystem::create_directories(choices.failures);
  std::ofstream out(file);
  write_case(out, small);
  std::cerr << "  " << small.faults.size() << " faults in " << small.ticks
            << " ticks are enough; see it again: kernel_campaign --replay " << file.string() << "\n";
}

/** What the kernel said of the failing axis in the last ticks of a case. */
void print_trace(const Case& plan, const Failure& failure, std::uint32_t ticks) {
  const auto world = std::make_unique<World>(plan);
  const std::size_t slot = failure.axis == kNoAxis ? 0 : static_cast<std::size_t>(failure.axis);
  for (std::uint32_t tick = 0; tick <= failure.tick; tick++) {
    static_cast<void>(world->step());
    const ilk_state_t& state = world->state();
    const ilk_axis_t& axis = state.axis[slot];
    if (failure.tick - tick < ticks) {
      std::cout << "tick " << tick << " mode " << state.system.mode << " cause " << state.system.cause
                << " pedal " << state.system.pedal << " armed " << state.system.pedal_armed << " | axis "
                << slot << " state " << axis.state << " fault " << axis.fault << " homed " << axis.homed
                << " valid " << axis.card_valid << " switch " << axis.switch_triggered << " position "
                << axis.position_counts << " setpoint " << axis.setpoint_counts << " lease "
                << axis.lease_ticks << " phase " << axis.homing_phase << " stall count "
                << axis.stall_driven_ticks << " effort " << axis.effort_low << " travel "
                << axis.unhomed_travel_counts << " homing " << axis.homing_travel_counts << " rest "
                << axis.rest.ticks << " drive " << world->outputs().command[slot].drive << " direction "
                << world->outputs().command[slot].direction << " gate " << world->outputs().gate[slot]
                << " true " << world->true_position(slot) << "\n";
    }
  }
}

int replay(const Choices& choices) {
  const std::filesystem::path& path = choices.replay;
  std::ifstream in(path);
  const auto plan = read_case(in);
  if (!plan) {
    std::cerr << path.string() << ": " << plan.error() << "\n";
    return 2;
  }
  const Outcome outcome = run(*plan);
  if (outcome.failure) {
    print_trace(*plan, *outcome.failure, choices.trace);
  }
  std::cout << (outcome.failure ? text_of(*outcome.failure) : "nothing unsafe, nothing late") << " (of "
            << outcome.totals.ticks << " ticks, digest " << outcome.totals.digest << ")\n";
  return outcome.failure ? 1 : 0;
}

int run_all(const Choices& choices) {
  Totals totals;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  nlohmann::json first_failure;
  const double started = processor_seconds();
  const auto goes_on = [&] {
    return choices.cases > 0 ? done < choices.cases : processor_seconds() - started < choices.seconds;
  };
  // After the first failure the rest of the time goes into making it small.
  while (goes_on() && failed == 0) {
    const Case plan = make_case(choices.seed, choices.first + done * choices.stride);
    const Outcome outcome = run(plan);
    totals.add(outcome.totals);
    done++;
    if (outcome.failure) {
      failed++;
      first_failure = {{"text", text_of(*outcome.failure)},
                       {"clause", outcome.failure->clause},
                       {"case", plan.number},
                       {"seconds", processor_seconds() - started}};
      report(choices, plan, *outcome.failure);
    }
  }
  nlohmann::json out = json_of(totals);
  out["seed"] = choices.seed;
  out["cases"] = done;
  out["processor_s"] = processor_seconds() - started;
  if (failed > 0) {
    out["first_failure"] = first_failure;
  }
  std::cout << out.dump() << "\n";
  return failed > 0 ? 1 : 0;
}

int main_of(int count, char** words) {
  Choices choices;
  CLI::App app{"Runs kernel core, plant and monitors together under randomised faults."};
  app.add_option("--seed", choices.seed, "of the campaign");
  app.add_option("--first", choices.first, "number of the first case");
  app.add_option("--stride", choices.stride, "from one case to the next")->check(CLI::PositiveNumber);
  app.add_option("--cases", choices.cases, "how many; 0: as many as --seconds allow");
  app.add_option("--seconds", choices.seconds, "of processor time");
  app.add_option("--failures", choices.failures, "folder for the files of failing cases");
  app.add_option("--replay", choices.replay, "runs the case in that file")->check(CLI::ExistingFile);
  app.add_option("--trace", choices.trace, "with --replay: shows so many ticks before the failure");
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (choices.replay.empty() && choices.cases == 0 && choices.seconds <= 0) {
    std::cerr << "expected --cases, --seconds or --replay\n";
    return 2;
  }
  return choices.replay.empty() ? run_all(choices) : replay(choices);
}

}  // namespace
}  // namespace interlock::campaign

int main(int count, char** words) { return interlock::campaign::main_of(count, words); }
