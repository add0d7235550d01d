#include "recorder/rescue.hpp"

#include <system_error>
#include <utility>

#include "recorder/ring.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

}  // namespace

fs::path unsaved_of(const fs::path& ring) { return ring.string() + ".unsaved"; }
fs::path unreadable_of(const fs::path& ring) { return ring.string() + ".unreadable"; }

Rescue::Rescue(fs::path ring, const RecordingFolder& folder, RecorderTerms terms, Tell tell)
    : ring_(std::move(ring)), folder_(folder), terms_(std::move(terms)), tell_(std::move(tell)) {}

void Rescue::begin() {
  step();
  std::error_code ignored;
  if (!fs::exists(ring_, ignored)) {
    return;
  }
  const Recorded<Ring> ring = Ring::open(ring_);
  if (!ring) {
    keep_unreadable(ring_);
  } else if (!ring->writer_lives()) {
    const std::uint32_t tick = ring->opening_tick(ring->head()).value_or(0);
    set_aside();
    settle(ring->head() == 0 || write_out(*ring, ring->block_before(tick, terms_.before_s)));
  }
}

void Rescue::set_aside() {
  std::error_code error;
  aside_ = !fs::exists(unsaved_of(ring_), error);
  if (aside_) {
    fs::rename(ring_, unsaved_of(ring_), error);
  }
}

void Rescue::settle(bool kept) {
  const fs::path file = aside_ ? unsaved_of(ring_) : ring_;
  if (kept) {
    std::error_code ignored;
    fs::remove(file, ignored);
    return;
  }
  retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  tell_("the black box is kept in memory as " + file.string() +
        (aside_ ? " until the disk takes it"
                : " until a kernel starts: an earlier one still waits for the disk"));
}

void Rescue::step() {
  std::error_code ignored;
  if (std::chrono::steady_clock::now() < retry_at_ || !fs::exists(unsaved_of(ring_), ignored)) {
    return;
  }
  const Recorded<Ring> ring = Ring::open(unsaved_of(ring_));
  if (!ring) {
    keep_unreadable(unsaved_of(ring_));
  } else if (write_out(*ring, ring->oldest())) {
    fs::remove(unsaved_of(ring_), ignored);
  } else {
    retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  }
}

void Rescue::keep_unreadable(const fs::path& ring) {
  if (Ring::left_by_another_release(ring)) {
    std::error_code ignored;
    fs::rename(ring, unreadable_of(ring_), ignored);
    tell_("a kernel of another release left a black box; kept in memory as " + unreadable_of(ring_).string());
  }
}

bool Rescue::write_out(const Ring& ring, std::uint32_t first_block) {
  const std::uint32_t tick = ring.opening_tick(ring.head()).value_or(0);
  const fs::path file = folder_.file(ring.run(), ILK_RECORDED_ON_RESCUE, tick);
  folder_.make_room();
  const Recorded<std::uint32_t> blocks =
      record_now(ring, file, {ILK_RECORDED_ON_RESCUE, tick, terms_.build}, first_block);
  tell_(blocks ? "rescued " + file.string() : "cannot record: " + blocks.error());
  return blocks.has_value();
}

}  // namespace interlock::recorder
