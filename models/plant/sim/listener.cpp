#include "plant/sim/listener.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>
#include <optional>

namespace interlock::plant::sim {
namespace {

constexpr int kBacklog = 16;

std::string system_reason() { return std::strerror(errno); }

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  return address;
}

const sockaddr* generic(const sockaddr_un& address) { return reinterpret_cast<const sockaddr*>(&address); }

/** Removes a socket that nobody serves any more; says why when the path is not free after that. */
std::optional<std::string> make_free(const std::string& path, int type) {
  struct stat found{};
  if (::lstat(path.c_str(), &found) != 0) {
    return errno == ENOENT ? std::nullopt : std::optional(path + ": " + system_reason());
  }
  if (!S_ISSOCK(found.st_mode)) {
    return path + ": exists and is no socket; remove it or choose another path";
  }
  const FileDescriptor probe(::socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_un address = address_of(path);
  if (::connect(probe.get(), generic(address), sizeof address) == 0 || errno != ECONNREFUSED) {
    return path + ": another process listens there; stop it or choose another path";
  }
  if (::unlink(path.c_str()) != 0) {
    return path + ": left by a dead process and cannot be removed: " + system_reason();
  }
  return std::nullopt;
}

}  // namespace

tl::expected<Listener, std::string> Listener::open(const std::filesystem::path& path, int type) {
  const std::string name = path.string();
  if (name.empty() || name.size() >= sizeof(sockaddr_un::sun_path)) {
    return tl::unexpected("'" + name + "': a socket path has 1 to " +
                          std::to_string(sizeof(sockaddr_un::sun_path) - 1) + " characters");
  }
  if (const auto reason = make_free(name, type)) {
    return tl::unexpected(*reason);
  }
  FileDescriptor socket(::socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_un address = address_of(name);
  const mode_t mask = ::umask(0077);
  const bool bound = socket.is_open() && ::bind(socket.get(), generic(address), sizeof address) == 0;
  const std::string bind_reason = system_reason();
  ::umask(mask);
  if (!bound) {
    return tl::unexpected(name + ": cannot be made: " + bind_reason);
  }
  struct stat made{};
  if (::listen(socket.get(), kBacklog) != 0 || ::lstat(name.c_str(), &made) != 0) {
    return tl::unexpected(name + ": cannot listen: " + system_reason());
  }
  return Listener(std::move(socket), path, made.st_dev, made.st_ino);
}

Listener::Listener(FileDescriptor socket, std::filesystem::path path, dev_t device, ino_t inode)
    : socket_(std::move(socket)), path_(std::move(path)), device_(device), inode_(inode) {}

Listener::Listener(Listener&& other) noexcept
    : socket_(std::move(other.socket_)),
      path_(std::exchange(other.path_, {})),
      device_(other.device_),
      inode_(other.inode_) {}

Listener::~Listener() {
  struct stat found{};
  if (!path_.empty() && ::lstat(path_.c_str(), &found) == 0 && found.st_dev == device_ &&
      found.st_ino == inode_) {
    ::unlink(path_.c_str());
  }
}

FileDescriptor Listener::accept() const {
  return FileDescriptor(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

}  // namespace interlock::plant::sim
