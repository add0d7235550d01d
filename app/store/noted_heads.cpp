#include "store/noted_heads.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "store/store_files.hpp"
#include "system/file_descriptor.hpp"

namespace interlock {

namespace fs = std::filesystem;

Stored<NotedHeads> read_noted_heads(const fs::path& file) {
  if (is_no_regular_file(file)) {
    return tl::unexpected(
        StoreError{StoreError::Kind::unavailable,
                   file.string() + " is not a regular file, so the noted heads cannot be read", "", "",
                   "see what replaced the recorder's file"});
  }
  std::ifstream stream(file);
  if (!stream) {
    const int reason = errno;
    return reason == ENOENT ? Stored<NotedHeads>(NotedHeads())
                            : tl::unexpected(file_error(file, "cannot be read", reason));
  }
  NotedHeads heads;
  for (std::string line; std::getline(stream, line);) {
    NotedHead noted;
    std::istringstream words(line);
    if (words >> noted.time >> noted.head.number >> noted.head.hash && noted.head.hash.size() == 64) {
      heads.push_back(std::move(noted));
    }
  }
  if (stream.bad()) {
    return tl::unexpected(file_error(file, "cannot be read", errno));
  }
  return heads;
}

bool note_head(const fs::path& file, const NotedHead& noted) {
  const FileDescriptor appended(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW));
  if (!appended) {
    return false;
  }
  // The line before may have been cut off; an empty one is none.
  const std::string line =
      '\n' + noted.time + ' ' + std::to_string(noted.head.number) + ' ' + noted.head.hash + '\n';
  return ::write(appended.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
         ::fdatasync(appended.get()) == 0;
}

bool report_head(const fs::path& socket, const AuditHead& head) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket.native().size() >= sizeof address.sun_path) {
    return false;
  }
  std::strcpy(address.sun_path, socket.c_str());
  const FileDescriptor sender(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!sender) {
    return false;
  }
  const std::string message = std::to_string(head.number) + ' ' + head.hash;
  const ssize_t sent = ::sendto(sender.get(), message.data(), message.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return sent == static_cast<ssize_t>(message.size());
}

}  // namespace interlock
