#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.hpp"
#include "cli/replay_views.hpp"
#include "cli/write_file.hpp"
#include "interlock/replay.h"
#include "recorder/recording_folder.hpp"
#include "robot/compile.hpp"
#include "system/utc_time.hpp"

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

struct FileCloser {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, FileCloser>;

/** What was asked for of each tick. */
struct Tables {
  ReplayedRobot robot;
  std::optional<ReplayJudge> judge;
  std::ofstream csv_file;
  std::optional<ReplayCsv> csv;
  std::optional<ReplayPlot> plot;
};

void add_tick(void* context, const ilk_state_t* before, const ilk_recorded_tick_t* tick) {
  auto& tables = *static_cast<Tables*>(context);
  if (tables.judge) {
    tables.judge->add(*before, *tick);
  }
  if (tables.csv) {
    tables.csv->add(*tick);
  }
  if (tables.plot) {
    tables.plot->add(*tick);
  }
}

Result<void> judge_header(ilk_header_result_t result, const fs::path& file) {
  switch (result) {
    case ILK_HEADER_GOOD:
      return {};
    case ILK_HEADER_NO_RECORDING:
      return failed(ExitCode::refused, file.string() + " is no recording");
    case ILK_HEADER_OTHER_RELEASE:
      return failed(ExitCode::refused, file.string() +
                                           " was recorded by another release; replay it with that one, which "
                                           "its header names");
    case ILK_HEADER_DAMAGED:
      break;
  }
  return failed(ExitCode::refused,
                file.string() + ": the header is damaged; nothing in the file is believed");
}

/** A word as its field is meant: integers with their sign. */
std::string value(const ilk_word_name_t& name, std::uint32_t word) {
  return name.integer ? std::to_string(static_cast<std::int32_t>(word)) : std::to_string(word);
}

std::string difference_line(const ilk_difference_t& difference) {
  std::string line = "tick " + std::to_string(difference.tick) + ": the kernel comes to other " +
                     (difference.outputs ? "outputs" : "words of its state");
  if (difference.words == 0) {
    return line + (difference.outputs ? ", from the same state" : "; no later recorded state shows which");
  }
  const ilk_word_name_t name = ilk_word_name(ilk_picture_fields(), difference.offset);
  return line + "; after tick " + std::to_string(difference.seen_tick) + ": " + name.text + ", bit " +
         std::to_string(difference.bit) + ": recorded " + value(name, difference.recorded) + ", replayed " +
         value(name, difference.replayed) + " (" + std::to_string(difference.words) +
         (difference.words == 1 ? " word differs there)" : " words differ there)");
}

std::string place(const ilk_recording_t& recording) {
  const std::string number = recording.number == 0 ? "a block" : "block " + std::to_string(recording.number);
  return number + " at byte " + std::to_string(recording.offset);
}

void describe(const ilk_recording_header_t& header, std::ostream& output) {
  const UtcTime begun{std::chrono::milliseconds(recorder::joined(header.run.begun_utc_ms))};
  output << "recorded: " << recorder::why_name(header.why) << ", tick " << header.tick << "; run of "
         << iso_8601(begun) << (header.run.simulated != 0 ? ", simulated" : ", hardware") << ", period "
         << header.run.config.common.period_us << " us, configuration " << config_hash(header.run.config)
         << ", by " << std::string(header.build, strnlen(header.build, sizeof header.build)) << '\n';
}

void describe(const ilk_replay_t& replayed, std::ostream& output) {
  output << replayed.ticks << " ticks";
  if (replayed.ticks > 0) {
    output << " (" << replayed.first_tick << " to " << replayed.last_tick << ')';
  }
  output << ", " << replayed.requests << " requests, " << replayed.blocks << " blocks, " << replayed.gaps
         << " gaps\n";
}

/** What the replay came to; the tables hold what was identical. */
Result<void> compare(const ilk_replay_report_t& report, const ilk_recording_t& recording,
                     std::ostream& output) {
  if (report.end == ILK_FILE_TORN) {
    output << "note: " << place(recording) << " was cut off while it was written; what is before it counts\n";
  }
  if (report.result == ILK_REPLAY_DIFFERS) {
    output << "differs\n";
    return failed(ExitCode::refused, difference_line(report.difference));
  }
  if (report.result == ILK_REPLAY_UNREADABLE || report.end == ILK_FILE_DAMAGED) {
    return failed(ExitCode::refused,
                  place(recording) +
                      " is damaged; nothing from there on is believed, and what is before it is "
                      "identical");
  }
  output << "identical\n";
  return {};
}

/** What the monitors say of the ticks that came out the same; `good` says how far these go. */
Result<void> judge(const ReplayJudge& judge, Result<void> good, std::ostream& output) {
  if (!judge.violation()) {
    output << ReplayJudge::monitors << " monitors accept " << judge.ticks() << " ticks\n";
    return good;
  }
  return failed(ExitCode::refused, describe(*judge.violation()) + (good ? "" : "; " + good.error().text));
}

Result<Tables> tables_for(const ReplayOptions& options, const ilk_recording_header_t& header) {
  Tables tables{ReplayedRobot(header.run.config), std::nullopt, {}, std::nullopt, std::nullopt};
  if (options.judge) {
    tables.judge.emplace(header.run.config);
  }
  if (!options.csv.empty()) {
    tables.csv_file.open(options.csv, std::ios::trunc);
  }
  if (!options.csv.empty() && !tables.csv_file) {
    return failed(ExitCode::precondition, options.csv.string() + " cannot be written");
  }
  return tables;
}

}  // namespace

Result<void> replay(const ReplayOptions& options, std::ostream& output) {
  const File file(std::fopen(options.file.c_str(), "rbe"));
  if (!file) {
    return failed(ExitCode::precondition, options.file.string() + " cannot be opened");
  }
  const auto recording = std::make_unique<ilk_recording_t>();
  if (Result<void> good = judge_header(ilk_recording_begin(recording.get(), file.get()), options.file);
      !good) {
    return good;
  }
  describe(recording->header, output);
  Result<Tables> tables = tables_for(options, recording->header);
  if (!tables) {
    return tl::unexpected(tables.error());
  }
  if (tables->csv_file.is_open()) {
    tables->csv.emplace(tables->robot, tables->csv_file);
  }
  if (!options.plot.empty()) {
    tables->plot.emplace(tables->robot, options.file.filename().string());
  }
  ilk_replay_report_t report{};
  ilk_replay_recording(recording.get(), &report, add_tick, &*tables);
  describe(report.replay, output);
  if (tables->csv_file.is_open() && !tables->csv_file.flush()) {
    return failed(ExitCode::precondition, options.csv.string() + " cannot be written");
  }
  if (tables->plot && report.replay.ticks > 0) {
    if (Result<void> drawn = write_file(options.plot, svg_of(tables->plot->chart())); !drawn) {
      return drawn;
    }
  }
  Result<void> good = compare(report, *recording, output);
  if (tables->judge) {
    good = judge(*tables->judge, std::move(good), output);
  }
  if (good && options.console) {
    good = show_in_console(options.show, options.file, recording->header.run.config, output);
  }
  return good;
}

}  // namespace interlock::cli
