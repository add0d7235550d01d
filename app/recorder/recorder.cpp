#include "recorder/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

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
    : ring_(ring),
      folder_(folder),
      terms_(std::move(terms)),
      tell_(std::move(tell)),
      held_s_(ring.seconds()) {}

void Recorder::step() {
  while (const std::optional<TickHead> head = ring_.next(place_)) {
    take_in(*head);
  }
  if (!active_ && newest_) {
    begin_recording();
  }
  append_complete_blocks();
  report_shortage();
}

/** Each whole second that the ring holds less than it was made for. */
void Recorder::report_shortage() {
  const double held_s = std::floor(ring_.fewest_seconds().value_or(held_s_));
  if (held_s < held_s_) {
    held_s_ = held_s;
    tell_("the black box holds " + std::to_string(static_cast<int>(held_s)) + " s, not " +
          std::to_string(ring_.seconds()) + ": more changes in each tick than it has room for");
  }
}

bool Recorder::finish() {
  retry_at_ = {};
  step();
  const bool lives = ring_.writer_lives();
  if (newest_ && !ring_.closed() && !lives) {
    event(ILK_RECORDED_ON_END, newest_->tick);
  }
  // One whose time is not over is left unfinished while the kernel lives: whoever comes next writes it anew.
  if (active_ && (!lives || !active_->last_tick || is_over())) {
    end_recording();
  }
  return !active_ && !event_ && (!terms_.continuous || may_write());
}

void Recorder::take_in(const TickHead& head) {
  // The run begins LOCKED (BOOT): that is where all starts, and no event.
  const std::optional<ilk_recorded_why_t> happened =
      newest_ ? event_between(newest_->alarm, head.alarm) : std::nullopt;
  newest_ = head;
  if (happened) {
    event(*happened, head.tick);
  }
  if (active_ && is_over()) {
    end_recording();
  }
}

void Recorder::event(ilk_recorded_why_t why, std::uint32_t tick) {
  if (terms_.continuous) {
    return;
  }
  const std::uint64_t after_us = std::uint64_t{terms_.after_s} * 1'000'000;
  const std::uint32_t last_tick =
      tick + static_cast<std::uint32_t>(after_us / ring_.run().config.common.period_us);
  if (active_) {
    active_->last_tick = last_tick;
    return;
  }
  event_ = event_ ? Event{event_->why, event_->tick, last_tick} : Event{why, tick, last_tick};
  begin_recording();
}

/** Of the event that waits for it, or of all. */
void Recorder::begin_recording() {
  if (event_) {
    begin(event_->why, event_->tick, ring_.block_before(event_->tick, terms_.before_s));
    if (active_) {
      active_->last_tick = event_->last_tick;
      event_.reset();
    }
  } else if (terms_.continuous) {
    const std::uint32_t first = std::max(ring_.oldest(), continuous_next_);
    begin(ILK_RECORDED_CONTINUOUSLY, ring_.opening_tick(first).value_or(newest_->tick), first);
  }
}

bool Recorder::may_write() const { return std::chrono::steady_clock::now() >= retry_at_; }

/** The ticks that a recording of an event holds are there. */
bool Recorder::is_over() const {
  return active_->last_tick && static_cast<std::int32_t>(newest_->tick - *active_->last_tick) >= 0;
}

void Recorder::begin(ilk_recorded_why_t why, std::uint32_t tick, std::uint32_t first_block) {
  if (!may_write()) {
    return;
  }
  Active recording{.why = why,
                   .tick = tick,
                   .file = folder_.file(ring_.run(), why, tick),
                   .first_block = first_block,
                   .next_block = first_block};
  std::error_code ignored;
  if (why != ILK_RECORDED_CONTINUOUSLY && fs::exists(recording.file, ignored)) {
    active_.emplace(std::move(recording));
    return;
  }
  set_aside(recording);
  folder_.make_room();
  if (create(recording)) {
    tell_("recording " + recording.file.string());
    active_.emplace(std::move(recording));
  }
}

/** What is there under the name already was begun by another recorder: it goes once there is as much anew. */
void Recorder::set_aside(Active& recording) const {
  std::error_code error;
  for (const fs::path& there : {part_of(recording.file), recording.file}) {
    if (fs::exists(there, error)) {
      const fs::path cut = cut_of(recording.file);
      fs::rename(there, cut, error);
      const bool ring_holds_all = recording.first_block > ring_.oldest() || recording.first_block <= 1;
      recording.cut = !error && ring_holds_all ? std::optional(cut) : std::nullopt;
    }
  }
}

bool Recorder::create(Active& recording) {
  Recorded<RecordingWriter> writer = RecordingWriter::create(part_of(recording.file), ring_.run(),
                                                             {recording.why, recording.tick, terms_.build});
  if (!writer) {
    fail(writer.error());
    return false;
  }
  recording.writer.emplace(std::move(*writer));
  return true;
}

/** After the disk refused, the file may be gone by the time it takes blocks again, or belong to another disk.
 */
bool Recorder::resume() {
  if (active_->refused && !active_->writer->reopen()) {
    if (!create(*active_)) {
      return false;
    }
    active_->next_block = std::max(active_->first_block, ring_.oldest());
    active_->cut.reset();
  }
  active_->refused = false;
  return true;
}

void Recorder::append_complete_blocks() {
  const std::uint32_t head = ring_.head();
  while (active_ && active_->next_block < head && append_next()) {
    if (!active_->last_tick && active_->writer->bytes() >= terms_.part_bytes) {
      complete();
      if (!active_) {
        begin_recording();
      }
    }
  }
}

/** False when the disk does not take the block: it is asked for it again. */
bool Recorder::append_next() {
  if (!active_->writer) {
    ++active_->next_block;
    return true;
  }
  if (!may_write() || !resume()) {
    return false;
  }
  const std::uint32_t number = active_->next_block;
  const std::optional<BlockCopy> block = ring_.copy(number);
  if (!block) {
    active_->cut.reset();
    active_->next_block = std::max(number + 1, ring_.oldest());
    tell_("the disk is too slow: lost blocks " + std::to_string(number) + " to " +
          std::to_string(active_->next_block - 1));
    return true;
  }
  if (const Recorded<void> appended = active_->writer->append(*block); !appended) {
    active_->refused = true;
    fail(appended.error());
    return false;
  }
  ++active_->next_block;
  return true;
}

/** It goes on when the disk does not take all of it. The block that is being written is taken as far as it
 * is. */
void Recorder::end_recording() {
  const std::uint32_t head = ring_.head();
  append_complete_blocks();
  while (active_ && active_->next_block <= head && append_next()) {
  }
  if (active_ && active_->next_block > head && (!active_->writer || (may_write() && resume()))) {
    complete();
  }
}

void Recorder::complete() {
  if (active_->writer) {
    std::error_code error;
    fs::rename(part_of(active_->file), active_->file, error);
    if (error) {
      // The newest block may have been copied while it was being written: it is asked for again.
      active_->refused = true;
      if (active_->writer->take_back_last()) {
        --active_->next_block;
      }
      fail(active_->file.string() + ": " + error.message());
      return;
    }
    tell_(active_->file.string() + " is complete");
    if (active_->cut) {
      fs::remove(*active_->cut, error);
    }
  }
  if (terms_.continuous) {
    continuous_next_ = active_->next_block;
  }
  active_.reset();
}

void Recorder::fail(const std::string& reason) {
  tell_("cannot record: " + reason);
  retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
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
      std::error_code ignored;
      fs::remove(file, ignored);
      return tl::unexpected(appended.error());
    }
    blocks += block ? 1 : 0;
  }
  return blocks;
}

}  // namespace interlock::recorder
