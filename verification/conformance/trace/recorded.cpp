/// Tells a recording of the black box to Trace.tla, in parts that TLC can read.
///
/// Usage: model_trace RECORDING FOLDER TICKS. Writes FOLDER/00001/TraceData.tla and so on, TICKS ticks each;
/// a part begins with the state that the one before ended with, and a gap in the recording begins a new one.
/// Prints the first tick of each part, a line each.
///
/// What a frame is to the model is read here by spec/frames.md, not by the kernel.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "interlock/kernel.h"
#include "interlock/recorded_block.h"
#include "interlock/recording_file.h"
#include "told.h"

namespace {

namespace fs = std::filesystem;

struct Closer {
  void operator()(FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<FILE, Closer>;

[[noreturn]] void give_up(const std::string& what) {
  std::cerr << "model_trace: " << what << '\n';
  std::exit(EXIT_FAILURE);
}

constexpr std::uint32_t kStartWord = 0xFEFEFE01u;
constexpr std::uint32_t kSwitchOpen = 0x00080000u;

using Frame = std::uint32_t[ILK_FRAME_WORDS];

/// Start word and checksum are right.
bool is_intact(const Frame& frame) {
  const std::uint32_t sum = std::accumulate(frame, frame + ILK_FRAME_WORDS - 1, 0u);
  return frame[0] == kStartWord && frame[ILK_FRAME_WORDS - 1] == ~sum;
}

/// What a motor card tells, of an intact frame.
struct Reading {
  std::uint32_t counter;
  std::uint32_t heartbeat;
  std::uint32_t tick_echo;
  bool switch_triggered;
};

Reading read(const Frame& frame) { return {frame[3], frame[9], frame[11], (frame[2] & kSwitchOpen) == 0}; }

/// Whether the card answered to the frame that it was sent two ticks ago; not judged before there is one.
bool is_timely(const Reading& reading, std::uint32_t tick) {
  return tick < 2 || reading.tick_echo == tick - 2;
}

const char* frame_kind(const ilk_inputs_t& in, std::uint32_t slot, const ilk_state_t& before) {
  const bool came = in.transaction_done == 1 && ((in.frames_received >> slot) & 1u) != 0;
  const ilk_axis_t& axis = before.axis[slot];
  if (!came) {
    return "MISSING";
  }
  if (!is_intact(in.frame[slot])) {
    return "CORRUPT";
  }
  const Reading reading = read(in.frame[slot]);
  if (!is_timely(reading, before.system.tick)) {
    return "LATE";
  }
  return axis.card_seen != 0 && reading.heartbeat == axis.heartbeat ? "REPEATED" : "GOOD";
}

told_reading_t reading_of(const ilk_config_t& config, const ilk_inputs_t& in, std::uint32_t slot,
                          const ilk_state_t& before) {
  const Reading reading = read(in.frame[slot]);
  told_reading_t told{frame_kind(in, slot, before), 0, reading.switch_triggered};
  if (std::string_view(told.frame) == "GOOD" && before.axis[slot].card_seen != 0) {
    const auto rise = static_cast<std::int32_t>(reading.counter - before.axis[slot].raw);
    const auto fall = static_cast<std::int32_t>(before.axis[slot].raw - reading.counter);
    told.moved = config.axis[slot].direction_correction != 0 ? fall : rise;
  }
  return told;
}

/// What the door must say of each request: its checksum, then whether it is newer than all before.
std::vector<const char*> doors(const ilk_recorded_tick_t& tick, std::uint32_t last_sequence) {
  std::vector<const char*> said;
  for (std::uint32_t n = 0; n < tick.request_count; ++n) {
    const ilk_request_t& request = tick.request[n];
    if (ilk_request_crc(&request) != request.crc) {
      said.push_back("CHECKSUM");
    } else if (static_cast<std::int32_t>(request.sequence - last_sequence) <= 0) {
      said.push_back("SEQUENCE");
    } else {
      said.push_back("INTACT");
      last_sequence = request.sequence;
    }
  }
  return said;
}

/// The modules, one after the other.
class Teller {
 public:
  Teller(const ilk_config_t& config, fs::path folder, std::uint32_t ticks)
      : config_(config), folder_(std::move(folder)), ticks_(ticks) {}

  /// From here on nothing continues what was told.
  void begin_anew() { end_part(); }

  void tell(const ilk_recorded_tick_t& tick, const ilk_state_t& before) {
    if (!file_) {
      begin_part(before);
    }
    const ilk_picture_t& now = tick.picture;
    told_tick_t told{};
    told.attached = now.inputs.link_generation != before.system.link_generation;
    told.config_pass = before.system.config_slice == ILK_SLOTS - 1u ? "AGREES" : "NONE";
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
      told.reading[slot] = reading_of(config_, now.inputs, slot, before);
    }
    const std::vector<const char*> said = doors(tick, told.attached ? 0 : before.system.last_sequence);
    told_tick(file_.get(), &config_, &told, &now.inputs, tick.request, said.data(), tick.request_count,
              &now.state, &now.out, in_part_ == 0);
    if (++in_part_ == ticks_) {
      end_part();
    }
  }

  void end_part() {
    if (file_) {
      told_end(file_.get());
      file_.reset();
    }
  }

 private:
  void begin_part(const ilk_state_t& before) {
    std::string number = std::to_string(++part_);
    number.insert(0, 5 - std::min<std::size_t>(number.size(), 5), '0');
    const fs::path folder = folder_ / number;
    fs::create_directories(folder);
    file_.reset(std::fopen((folder / "TraceData.tla").c_str(), "we"));
    if (!file_) {
      give_up(folder.string() + " cannot be written");
    }
    told_begin(file_.get(), &config_, &before, before.system.tick == 0);
    in_part_ = 0;
    std::cout << before.system.tick + 1 << '\n';
  }

  const ilk_config_t& config_;
  fs::path folder_;
  std::uint32_t ticks_;
  std::uint32_t part_ = 0;
  std::uint32_t in_part_ = 0;
  File file_;
};

void tell_block(const ilk_recording_t& recording, bool continues, Teller& teller) {
  const auto tick = std::make_unique<ilk_recorded_tick_t>();
  ilk_block_cursor_t cursor{};
  if (!ilk_block_begin(&cursor, &recording.header.run.config, recording.payload, recording.used,
                       tick.get())) {
    give_up("a block has no opening");
  }
  if (!continues) {
    teller.begin_anew();
  }
  for (;;) {
    const ilk_state_t before = tick->picture.state;
    switch (ilk_block_next(&cursor, tick.get())) {
      case ILK_TICK_READ:
        teller.tell(*tick, before);
        break;
      case ILK_TICK_NONE:
        return;
      default:
        give_up("a record is damaged, or this kernel differs; replay the recording first");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned long ticks = argc == 4 ? std::strtoul(argv[3], nullptr, 10) : 0;
  if (ticks == 0) {
    give_up("expected RECORDING FOLDER TICKS");
  }
  const File file(std::fopen(argv[1], "rbe"));
  const auto recording = std::make_unique<ilk_recording_t>();
  if (!file || ilk_recording_begin(recording.get(), file.get()) != ILK_HEADER_GOOD) {
    give_up(std::string(argv[1]) + " is no recording of this release");
  }
  Teller teller(recording->header.run.config, argv[2], static_cast<std::uint32_t>(ticks));
  for (std::uint32_t next = 0; ilk_recording_next(recording.get()) == ILK_FILE_BLOCK;
       next = recording->number + 1) {
    tell_block(*recording, recording->number == next, teller);
  }
  teller.end_part();
}
