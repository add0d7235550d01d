#include "recorder/recording_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <utility>
#include <vector>

namespace interlock::recorder {
namespace {

ilk_recording_header_t header_of(const ilk_run_description_t& run, const RecordingSubject& subject) {
  ilk_recording_header_t header{};
  header.why = subject.why;
  header.tick = subject.tick;
  subject.build.copy(header.build, sizeof header.build - 1);
  header.run = run;
  ilk_recording_seal_header(&header);
  return header;
}

/** Header, payload and trailer, as they stand in the file. */
std::vector<std::uint32_t> encoded(const BlockCopy& block) {
  const auto used = static_cast<std::uint32_t>(block.payload.size());
  const ilk_block_header_t header = ilk_recording_block_header(block.number, block.payload.data(), used);
  const auto* const head = reinterpret_cast<const std::uint32_t*>(&header);
  std::vector<std::uint32_t> words(head, head + sizeof header / sizeof *head);
  words.insert(words.end(), block.payload.begin(), block.payload.end());
  words.push_back(ILK_BLOCK_TRAILER(block.number));
  return words;
}

/** For as long as the file is open: a recorder that begins leaves it alone (RecordingFolder::finish_parts).
 */
void hold(const FileDescriptor& file) { static_cast<void>(flock(file.get(), LOCK_EX | LOCK_NB)); }

}  // namespace

Recorded<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                  const ilk_run_description_t& run,
                                                  const RecordingSubject& subject) {
  FileDescriptor file(
      open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR));
  if (!file) {
    return failed_with(path.string(), errno);
  }
  hold(file);
  RecordingWriter writer(std::move(file), path.string());
  const ilk_recording_header_t header = header_of(run, subject);
  const FileDescriptor folder(open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  Recorded<void> written = writer.write(&header, sizeof header);
  if (written && (!folder || fsync(folder.get()) != 0)) {
    written = failed_with(path.parent_path().string(), errno);
  }
  if (!written) {
    unlink(path.c_str());
    return tl::unexpected(written.error());
  }
  return writer;
}

bool RecordingWriter::reopen() {
  FileDescriptor file(open(name_.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW));
  struct stat there{};
  if (!file || fstat(file.get(), &there) != 0 || static_cast<std::uint64_t>(there.st_size) < bytes_) {
    return false;
  }
  file_ = std::move(file);
  hold(file_);
  return ftruncate(file_.get(), static_cast<off_t>(bytes_)) == 0;
}

bool RecordingWriter::take_back_last() {
  const bool is_there = last_bytes_ > 0;
  bytes_ -= std::exchange(last_bytes_, 0);
  return is_there;
}

Recorded<void> RecordingWriter::append(const BlockCopy& block) {
  const std::vector<std::uint32_t> words = encoded(block);
  const std::uint64_t before = bytes_;
  return write(words.data(), words.size() * sizeof words.front()).map([&] { last_bytes_ = bytes_ - before; });
}

Recorded<void> RecordingWriter::write(const void* bytes, std::size_t count) {
  Recorded<void> written = write_at_end(bytes, count);
  if (written) {
    bytes_ += count;
  } else if (ftruncate(file_.get(), static_cast<off_t>(bytes_)) != 0) {
    // Half a block at the end is told as torn; it is no reason to fail otherwise than by what failed.
    return written;
  }
  return written;
}

Recorded<void> RecordingWriter::write_at_end(const void* bytes, std::size_t count) {
  const auto* from = static_cast<const std::byte*>(bytes);
  std::size_t left = count;
  while (left > 0) {
    const ssize_t written = pwrite(file_.get(), from, left, static_cast<off_t>(bytes_ + count - left));
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return failed_with(name_, errno);
    }
    from += written;
    left -= static_cast<std::size_t>(written);
  }
  return fdatasync(file_.get()) == 0 ? Recorded<void>() : failed_with(name_, errno);
}

}  // namespace interlock::recorder
