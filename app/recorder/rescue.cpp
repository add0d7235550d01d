#include "recorder/rescue.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

/** Between two looks at the ring of a living kernel no more is written, so that it is never left alone for
 * long. */
constexpr std::uint32_t blocks_a_step = 8;

std::array<fs::path, 2> names_of(const fs::path& ring) {
  return {fs::path(ring.string() + ILK_RING_BEFORE), ring};
}

}  // namespace

Rescue::Rescue(fs::path ring, const RecordingFolder& folder, std::string build, Tell tell)
    : ring_(std::move(ring)), folder_(folder), build_(std::move(build)), tell_(std::move(tell)) {}

void Rescue::look(const Ring* followed) {
  for (const fs::path& file : names_of(ring_)) {
    look_at(file, followed);
  }
}

void Rescue::look_at(const fs::path& file, const Ring* followed) {
  const auto is_this = [&](const Ring& ring) { return ring.is_file(file); };
  std::error_code ignored;
  if (!fs::exists(file, ignored) || (followed != nullptr && is_this(*followed)) ||
      std::ranges::any_of(jobs_, is_this, &Job::ring)) {
    return;
  }
  Recorded<Ring> ring = Ring::open(file);
  if (!ring) {
    if (Ring::left_by_another_release(file) && told_.insert(file).second) {
      tell_(ring.error() + ", which died; it stays in memory until that release, or a person, takes it");
    }
  } else if (!ring->writer_lives()) {
    take(std::move(*ring));
  }
}

void Rescue::take(Ring ring) {
  if (ring.head() == 0) {
    let_go(ring);
    return;
  }
  const std::uint32_t tick = ring.opening_tick(ring.head()).value_or(0);
  fs::path file = folder_.file(ring.run(), ILK_RECORDED_ON_RESCUE, tick);
  jobs_.push_back({std::move(ring), std::move(file), std::nullopt, 0});
}

void Rescue::step() {
  if (jobs_.empty() || std::chrono::steady_clock::now() < retry_at_) {
    return;
  }
  Job& job = jobs_.front();
  if (const Recorded<void> written = begin(job).and_then([&] { return write_some(job); }); !written) {
    fail(job, written.error());
  } else if (!job.writer) {
    tell_("rescued " + job.file.string());
    let_go(job.ring);
    jobs_.pop_front();
  }
}

/** Begins the file, if it has not begun, and all of the ring has room on the disk. One that is there is half
 * of it. */
Recorded<void> Rescue::begin(Job& job) {
  if (job.writer) {
    return {};
  }
  folder_.make_room();
  std::error_code none;
  fs::remove(job.file, none);
  const std::uint32_t first = job.ring.oldest();
  const std::uintmax_t needed = std::uintmax_t{job.ring.head() - first + 1} * ILK_BLOCK_BYTES;
  std::error_code error;
  const fs::space_info space = fs::space(folder_.path(), error);
  if (!error && space.available < needed) {
    return tl::unexpected(job.file.string() + ": needs " + std::to_string(needed >> 20) + " MiB, of which " +
                          std::to_string(space.available >> 20) + " are free");
  }
  const std::uint32_t tick = job.ring.opening_tick(job.ring.head()).value_or(0);
  Recorded<RecordingWriter> writer =
      RecordingWriter::create(part_of(job.file), job.ring.run(), {ILK_RECORDED_ON_RESCUE, tick, build_});
  return writer.map([&](RecordingWriter& made) {
    job.writer.emplace(std::move(made));
    job.next_block = first;
  });
}

/** The writer is gone once all is written. */
Recorded<void> Rescue::write_some(Job& job) {
  const std::uint32_t last = job.ring.head();
  for (std::uint32_t n = 0; n < blocks_a_step && job.next_block <= last; ++n, ++job.next_block) {
    if (const std::optional<BlockCopy> block = job.ring.copy(job.next_block)) {
      if (Recorded<void> appended = job.writer->append(*block); !appended) {
        return appended;
      }
    }
  }
  if (job.next_block > last) {
    std::error_code error;
    fs::rename(part_of(job.file), job.file, error);
    if (error) {
      return tl::unexpected(job.file.string() + ": " + error.message());
    }
    job.writer.reset();
  }
  return {};
}

/** Half of a ring would only take the room of what else is to be recorded. The next one may be smaller. */
void Rescue::fail(Job& job, const std::string& reason) {
  std::error_code ignored;
  job.writer.reset();
  fs::remove(part_of(job.file), ignored);
  tell_("cannot record what a dead kernel left, and keep it in memory: " + reason);
  retry_at_ = std::chrono::steady_clock::now() + pause_after_failure;
  jobs_.push_back(std::move(job));
  jobs_.pop_front();
}

void Rescue::let_go(const Ring& ring) const {
  const fs::path gone = ring_.string() + ".gone";
  for (const fs::path& file : names_of(ring_)) {
    std::error_code error;
    if (!ring.is_file(file)) {
      continue;
    }
    // A kernel may take the name between the look and the removal: then it gets it back.
    fs::rename(file, gone, error);
    if (!error && !ring.is_file(gone)) {
      fs::create_hard_link(gone, file, error);
    }
    fs::remove(gone, error);
  }
}

}  // namespace interlock::recorder
