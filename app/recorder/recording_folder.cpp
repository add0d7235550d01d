#include "recorder/recording_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "system/file_descriptor.hpp"
#include "system/utc_time.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

constexpr const char* finished_ending = ".ilkr";
constexpr const char* part_ending = ".part";

/** "20240501T123456.789Z": sorts by time, and every file system takes it. */
std::string compact_time(std::uint64_t utc_ms) {
  std::string time = iso_8601(UtcTime(std::chrono::milliseconds(utc_ms)));
  std::erase_if(time, [](char c) { return c == '-' || c == ':'; });
  return time;
}

struct Kept {
  fs::file_time_type time;
  std::uintmax_t bytes;
  fs::path file;
};

/** As far as the disk tells; going on with an iterator would throw where it does not. */
std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    found.push_back(*entry);
  }
  return found;
}

std::vector<Kept> finished_in(const fs::path& folder) {
  std::vector<Kept> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : entries_of(folder)) {
    if (entry.path().extension() == finished_ending && entry.is_regular_file(ignored)) {
      found.push_back({entry.last_write_time(ignored), entry.file_size(ignored), entry.path()});
    }
  }
  std::ranges::sort(found, {}, [](const Kept& kept) { return std::pair(kept.time, kept.file); });
  return found;
}

/** By the recorder of a run that ended, which has not written out all of it yet. */
bool is_being_written(const fs::path& part) {
  const FileDescriptor file(::open(part.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  return file && flock(file.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace

Recorded<RecordingFolder> RecordingFolder::open(fs::path folder, std::uint64_t keep_bytes) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return tl::unexpected(folder.string() + ": " + error.message());
  }
  return RecordingFolder(std::move(folder), keep_bytes);
}

fs::path RecordingFolder::file(const ilk_run_description_t& run, ilk_recorded_why_t why,
                               std::uint32_t tick) const {
  return folder_ / recording_name(run, why, tick);
}

void RecordingFolder::finish_parts(const ilk_run_description_t* going_on) const {
  const std::string kept = going_on == nullptr ? "" : compact_time(joined(going_on->begun_utc_ms)) + '-';
  std::error_code ignored;
  for (const fs::directory_entry& entry : entries_of(folder_)) {
    fs::path finished = entry.path();
    finished.replace_extension();
    const bool is_kept = going_on != nullptr && entry.path().filename().string().starts_with(kept);
    if (entry.path().extension() == part_ending && finished.extension() == finished_ending && !is_kept &&
        !fs::exists(finished, ignored) && !is_being_written(entry.path())) {
      fs::rename(entry.path(), finished, ignored);
    }
  }
}

void RecordingFolder::make_room() const {
  const std::vector<Kept> kept = finished_in(folder_);
  std::uintmax_t bytes = 0;
  for (const Kept& recording : kept) {
    bytes += recording.bytes;
  }
  std::error_code ignored;
  for (const Kept& recording : kept) {
    if (bytes <= keep_bytes_) {
      return;
    }
    fs::remove(recording.file, ignored);
    bytes -= recording.bytes;
  }
}

std::string recording_name(const ilk_run_description_t& run, ilk_recorded_why_t why, std::uint32_t tick) {
  return compact_time(joined(run.begun_utc_ms)) + '-' + why_name(why) + '-' + std::to_string(tick) +
         finished_ending;
}

fs::path part_of(const fs::path& file) { return file.string() + part_ending; }

fs::path cut_of(const fs::path& file) {
  std::error_code ignored;
  fs::path cut;
  for (int n = 1; cut.empty() || fs::exists(cut, ignored); ++n) {
    cut = file.parent_path() / (file.stem().string() + "-cut-" + std::to_string(n) + finished_ending);
  }
  return cut;
}

std::string why_name(std::uint32_t why) {
  constexpr std::array names{"continuous", "lock", "fault", "demand", "end"};
  static_assert(names.size() == ILK_RECORDED_WHYS);
  return why < names.size() ? names[why] : "unknown";
}

}  // namespace interlock::recorder
