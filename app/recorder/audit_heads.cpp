#include "recorder/audit_heads.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>

#include "system/utc_time.hpp"

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

/** "NUMBER HASH": nothing else gets into the file, whoever sends it. */
bool is_head(std::string_view message) {
  constexpr std::string_view digits = "0123456789";
  constexpr std::size_t most_digits = 19;
  constexpr std::size_t hash_digits = 64;
  const std::size_t number = std::min(message.find_first_not_of(digits), message.size());
  return number > 0 && number <= most_digits && message.size() == number + 1 + hash_digits &&
         message[number] == ' ' &&
         message.find_first_not_of("0123456789abcdef", number + 1) == std::string_view::npos;
}

/** A line that a loss of power cut off ends here, so that the next one begins a line. */
bool end_last_line(int file) {
  char last = '\n';
  const off_t end = ::lseek(file, 0, SEEK_END);
  return end <= 0 || ::pread(file, &last, 1, end - 1) != 1 || last == '\n' || ::write(file, "\n", 1) == 1;
}

}  // namespace

Recorded<AuditHeads> AuditHeads::open(const fs::path& socket, const fs::path& file) {
  constexpr mode_t for_us_to_write = 0640;
  constexpr mode_t for_the_group = 0660;
  FileDescriptor kept(
      ::open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, for_us_to_write));
  if (!kept || !end_last_line(kept.get())) {
    return failed_with(file.string(), errno);
  }
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket.native().size() >= sizeof address.sun_path) {
    return failed_with(socket.string(), ENAMETOOLONG);
  }
  std::ranges::copy(socket.native(), std::begin(address.sun_path));
  FileDescriptor taking(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  // One that was killed left its own.
  ::unlink(socket.c_str());
  if (!taking || ::bind(taking.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(socket.c_str(), for_the_group) != 0) {
    return failed_with(socket.string(), errno);
  }
  return AuditHeads(std::move(taking), std::move(kept));
}

void AuditHeads::step() {
  receive();
  if (newest_ != appended_ && std::chrono::steady_clock::now() >= next_) {
    append();
  }
}

void AuditHeads::finish() {
  receive();
  if (newest_ != appended_) {
    append();
  }
}

void AuditHeads::receive() {
  std::array<char, 128> message{};
  for (int most = 100; most > 0; --most) {
    const ssize_t length = ::recv(socket_.get(), message.data(), message.size(), 0);
    if (length < 0) {
      return;
    }
    if (const std::string_view head(message.data(), static_cast<std::size_t>(length)); is_head(head)) {
      newest_ = head;
    }
  }
}

/** One that the disk refuses is appended with a later one; half a line is ended before it. */
void AuditHeads::append() {
  next_ = std::chrono::steady_clock::now() + pause;
  const std::string line = iso_8601(std::chrono::system_clock::now()) + ' ' + newest_ + '\n';
  if (end_last_line(file_.get()) &&
      ::write(file_.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
      ::fdatasync(file_.get()) == 0) {
    appended_ = newest_;
  }
}

}  // namespace interlock::recorder
