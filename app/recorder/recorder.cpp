#include "recorder/recorder.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/** After the disk refused: a full one does not get free sooner by asking at every step. */
constexpr auto pause_after_failure = 10s;

constexpr std::uint32_t mode_of(std::uint32_t alarm) { return alarm & 0xFU; }
constexpr std::uint32_t mode_and_cause_of(std::uint32_t alarm) { return alarm & 0xFFU; }
constexpr std::uint32_t faults_of(std::uint32_t alarm) { return alarm >> 8; }

/** What happened between two ticks, if it is worth a recording. */
std::optional<ilk_recorded_why_t> event_between(std::uint32_t before, std::uint32_t now) {
  if (mode_of(now) == ILK_MODE_LOCKED && mode_and_cause_of(now) != mode_and_cause_of(before)) {
    return ILK_RECORDED_ON_LOCK;
  }
  return (faults_of(now) & ~faults_of(before)) != 0 ? std::optional(ILK_RECORDED_ON_FAULT) : std::nullopt;
}

}  // namespace

Recorder::Recorder(const Ring& ring, const RecordingFolder& folder, RecorderTerms terms, Tell tell)
    : ring_(ring), folder_(folder), terms_(std::move(terms)), tell_(std::move(tell)) {}

void Recorder::step() {
  while (const std::optional<TickHead> head = ring_.next(place_)) {
    take_in(*head);
  }
  if (terms_.continuous && !active_ && newest_) {
    const std::uint32_t first = ring_.oldest();
    begin(ILK_RECORDED_CONTINUOUSLY, ring_.opening_tick(first).value_or(newest_->tick), first);
  }
  append_complete_blocks();
}

void Recorder::finish() {
  step();
  if (newest_ && !ring_.closed() && !ring_.writer_lives()) {
    event(ILK_RECORDED_ON_END, newest_->tick);
  }
  if (active_) {
    end_recording();
  }
}

void Recorder::take_in(const TickHead& head) {
  // The run begins LOCKED (BOOT): that is where all starts, and no event.
  const std::optional<ilk_recorded_why_t> happened =
      newest_ ? event_between(newest_->alarm, head.alarm) : std::nullopt;
  newest_ = head;
  if (happened) {
    event(*happened, head.tick);
  }
  if (active_ && active_->last_tick && static_cast<std::int32_t>(head.tick - *active_->last_tick) >= 0) {
    end_recording();
  }
}

void Recorder::event(ilk_recorded_why_t why, std::uint32_t tick) {
  if (active_ && !active_->last_tick) {
    return;
  }
  if (!active_) {
    begin(why, tick, ring_.block_before(tick, terms_.before_s));
  }
  if (active_) {
    const std::uint64_t after_us = std::uint64_t{terms_.after_s} * 1'000'000;
    active_->last_tick = tick + static_cast<std::uint32_t>(after_us / ring_.run().config.period_us);
  }
}

bool Recorder::may_begin() const { return std::chrono::steady_clock::now() >= retry_at_; }

void Recorder::begin(ilk_recorded_why_t why, std::uint32_t tick, std::uint32_t first_block) {
  if (!may_begin()) {
    return;
  }
  Active recording{folder_.file(ring_.run(), why, tick), std::nullopt, first_block, std::nullopt};
  std::error_code ignored;
  if (why == ILK_RECORDED_CONTINUOUSLY || !fs::exists(recording.file, ignored)) {
    folder_.make_room();
    Recorded<RecordingWriter> writer =
        RecordingWriter::create(part_of(recording.file), ring_.run(), {why, tick, terms_.build});
    if (!writer) {
      fail(writer.error());
      return;
    }
    recording.writer.emplace(std::move(*writer));
    tell_("recording " + recording.file.string());
  }
  active_.emplace(std::move(recording));
}

void Recorder::append_complete_blocks() {
  const std::uint32_t head = ring_.head();
  while (active_ && active_->next_block < head) {
    append(active_->next_block);
    if (active_ && !active_->last_tick && active_->writer->bytes() >= terms_.part_bytes) {
      go_on_in_a_new_part();
    }
  }
}

void Recorder::append(std::uint32_t number) {
  active_->next_block = number + 1;
  if (!active_->writer) {
    return;
  }
  const std::optional<BlockCopy> block = ring_.copy(number);
  if (!block) {
    active_->next_block = std::max(number + 1, ring_.oldest());
    tell_("the disk is too slow: lost blocks " + std::to_string(number) + " to " +
          std::to_string(active_->next_block - 1));
    return;
  }
  if (const Recorded<void> appended = active_->writer->append(*block); !appended) {
    fail(appended.error());
  }
}

void Recorder::go_on_in_a_new_part() {
  const std::uint32_t next = active_->next_block;
  complete();
  begin(ILK_RECORDED_CONTINUOUSLY, ring_.opening_tick(next).value_or(newest_->tick), next);
}

void Recorder::end_recording() {
  append_complete_blocks();
  if (active_ && active_->next_block == ring_.head()) {
    append(active_->next_block);
  }
  if (active_) {
    complete();
  }
}

void Recorder::complete() {
  if (active_->writer) {
    std::error_code error;
    fs::rename(part_of(active_->file), active_->file, error);
    tell_(error ? part_of(active_->file).string() + ": " + error.message()
                : active_->file.string() + " is complete");
  }
  active_.reset();
}

void Recorder::fail(const std::string& reason) {
  tell_("cannot record: " + reason);
  retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  active_.reset();
}

Recorded<std::uint32_t> record_now(const Ring& ring, const fs::path& file, const RecordingSubject& subject,
                                   std::uint32_t seconds) {
  Recorded<RecordingWriter> writer = RecordingWriter::create(file, ring.run(), subject);
  if (!writer) {
    return tl::unexpected(writer.error());
  }
  const std::uint32_t last = ring.head();
  std::uint32_t blocks = 0;
  for (std::uint32_t number = ring.block_before(subject.tick, seconds); number <= last; ++number) {
    const std::optional<BlockCopy> block = ring.copy(number);
    if (const Recorded<void> appended = block ? writer->append(*block) : Recorded<void>(); !appended) {
      return tl::unexpected(appended.error());
    }
    blocks += block ? 1 : 0;
  }
  return blocks;
}

}  // namespace interlock::recorder
