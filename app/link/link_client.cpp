#include "link/link_client.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "interlock/kernel.h"
#include "interlock/link_reader.h"

namespace interlock {
namespace {

tl::unexpected<LinkError> failure(LinkError::Kind kind, std::string detail) {
  return tl::make_unexpected(LinkError{kind, std::move(detail)});
}

std::string system_reason(int error) { return std::string(std::strerror(error)); }

std::string hex(std::uint32_t value) {
  constexpr char digits[] = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) {
    text += digits[(value >> shift) & 0xFu];
  }
  return text;
}

tl::expected<FileDescriptor, LinkError> connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    return failure(LinkError::Kind::broken, "link socket \"" + path + "\": the path must have 1 to " +
                                                std::to_string(sizeof address.sun_path - 1) + " bytes");
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  FileDescriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return failure(LinkError::Kind::unreachable, "link socket \"" + path + "\": " + system_reason(errno));
  }
  return socket;
}

/** The hello and whatever descriptors came with it; descriptors beyond the two are closed on return. */
struct Received {
  ssize_t bytes = 0;
  ilk_link_hello_t hello{};
  std::array<FileDescriptor, 2> regions;
  std::size_t descriptors = 0;
  bool truncated = false;
};

Received receive_hello(const FileDescriptor& socket) {
  Received received;
  iovec buffer{&received.hello, sizeof received.hello};
  constexpr std::size_t room = 4;
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(room * sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  received.bytes = ::recvmsg(socket.get(), &message, MSG_CMSG_CLOEXEC);
  if (received.bytes < 0) {
    return received;
  }
  received.truncated = (message.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr; header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) {
      continue;
    }
    const std::size_t count = (header->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(header) + i * sizeof fd, sizeof fd);
      FileDescriptor owned(fd);
      if (received.descriptors < received.regions.size()) {
        received.regions[received.descriptors] = std::move(owned);
      }
      ++received.descriptors;
    }
  }
  return received;
}

tl::expected<void, LinkError> check_hello(const ilk_link_hello_t& hello) {
  if (hello.magic != ILK_LINK_MAGIC) {
    return failure(LinkError::Kind::broken,
                   "hello starts with " + hex(hello.magic) + ", expected " + hex(ILK_LINK_MAGIC));
  }
  if (hello.version != ILK_LINK_VERSION) {
    return failure(LinkError::Kind::incompatible, "the kernel speaks link version " +
                                                      std::to_string(hello.version) + ", this app version " +
                                                      std::to_string(ILK_LINK_VERSION));
  }
  if (hello.layout_hash != ilk_link_layout_hash()) {
    return failure(LinkError::Kind::incompatible, "the kernel's link layout is " + hex(hello.layout_hash) +
                                                      ", this app's is " + hex(ilk_link_layout_hash()));
  }
  if (hello.kernel_region_bytes < sizeof(ilk_link_kernel_region_t) ||
      hello.app_region_bytes < sizeof(ilk_link_app_region_t)) {
    return failure(LinkError::Kind::broken, "regions of " + std::to_string(hello.kernel_region_bytes) +
                                                " and " + std::to_string(hello.app_region_bytes) +
                                                " bytes, expected at least " +
                                                std::to_string(sizeof(ilk_link_kernel_region_t)) + " and " +
                                                std::to_string(sizeof(ilk_link_app_region_t)));
  }
  return {};
}

/** Touching a page beyond the end of a shrunken file would kill the app, so the file must be sealed against
 * it. */
tl::expected<void, LinkError> check_region(const FileDescriptor& region, std::uint32_t bytes,
                                           const char* name) {
  struct stat status{};
  if (::fstat(region.get(), &status) != 0 || status.st_size < static_cast<off_t>(bytes)) {
    return failure(LinkError::Kind::broken, std::string("the ") + name + " region has " +
                                                std::to_string(status.st_size) + " bytes, the hello says " +
                                                std::to_string(bytes));
  }
  const int seals = ::fcntl(region.get(), F_GET_SEALS);
  if (seals < 0 || (seals & F_SEAL_SHRINK) == 0) {
    return failure(LinkError::Kind::broken,
                   std::string("the ") + name + " region is not sealed against shrinking");
  }
  return {};
}

}  // namespace

tl::expected<void, LinkError> LinkClient::attach(std::chrono::milliseconds hello_timeout) {
  detach();
  auto socket = connect_to(path_);
  if (!socket) {
    return tl::make_unexpected(std::move(socket).error());
  }
  pollfd readable{socket->get(), POLLIN, 0};
  if (::poll(&readable, 1, static_cast<int>(hello_timeout.count())) != 1) {
    return failure(LinkError::Kind::silent, "link socket \"" + path_ + "\": no hello within " +
                                                std::to_string(hello_timeout.count()) + " ms");
  }
  Received received = receive_hello(*socket);
  if (received.bytes == 0) {
    return failure(LinkError::Kind::unreachable,
                   "link socket \"" + path_ + "\": the kernel closed the connection");
  }
  if (received.bytes != static_cast<ssize_t>(sizeof received.hello) || received.truncated ||
      received.descriptors != received.regions.size()) {
    return failure(LinkError::Kind::broken, "hello of " + std::to_string(received.bytes) + " bytes with " +
                                                std::to_string(received.descriptors) +
                                                " descriptors, expected " +
                                                std::to_string(sizeof received.hello) + " bytes with 2");
  }
  auto adopted = adopt(received.hello, std::move(received.regions[0]), std::move(received.regions[1]));
  constexpr std::uint32_t mapped = ILK_LINK_MAGIC;
  if (adopted && ::send(socket->get(), &mapped, sizeof mapped, MSG_NOSIGNAL) != sizeof mapped) {
    adopted = failure(LinkError::Kind::unreachable, "link socket \"" + path_ + "\": " + system_reason(errno));
  }
  if (adopted) {
    socket_ = std::move(*socket);
  } else {
    detach();
  }
  return adopted;
}

tl::expected<void, LinkError> LinkClient::adopt(const ilk_link_hello_t& hello, FileDescriptor kernel,
                                                FileDescriptor app) {
  auto checked = check_hello(hello)
                     .and_then([&] { return check_region(kernel, hello.kernel_region_bytes, "kernel's"); })
                     .and_then([&] { return check_region(app, hello.app_region_bytes, "app's"); });
  if (!checked) {
    return checked;
  }
  kernel_mapping_ = SharedMapping(kernel, sizeof(ilk_link_kernel_region_t), SharedMapping::Access::read_only);
  if (kernel_mapping_.data() == nullptr) {
    return failure(LinkError::Kind::broken, "the kernel's region cannot be mapped: " + system_reason(errno));
  }
  app_mapping_ = SharedMapping(app, sizeof(ilk_link_app_region_t), SharedMapping::Access::read_write);
  if (app_mapping_.data() == nullptr) {
    return failure(LinkError::Kind::broken, "the app's region cannot be mapped: " + system_reason(errno));
  }
  const auto* kernel_region = static_cast<const ilk_link_kernel_region_t*>(kernel_mapping_.data());
  if (kernel_region->magic != hello.magic || kernel_region->version != hello.version ||
      kernel_region->layout_hash != hello.layout_hash ||
      __atomic_load_n(&kernel_region->generation, __ATOMIC_RELAXED) != hello.generation) {
    return failure(LinkError::Kind::broken, "the kernel's region is not the one that the hello announces");
  }
  kernel_ = kernel_region;
  app_ = static_cast<ilk_link_app_region_t*>(app_mapping_.data());
  generation_ = hello.generation;
  sequence_ = 0;
  events_read_ = 0;
  events_lost_ = 0;
  lock_read_ = 0;
  app_->magic = ILK_LINK_MAGIC;
  return {};
}

void LinkClient::detach() noexcept {
  kernel_ = nullptr;
  app_ = nullptr;
  generation_ = 0;
  kernel_mapping_ = SharedMapping();
  app_mapping_ = SharedMapping();
  socket_ = FileDescriptor();
}

bool LinkClient::peer_alive() const noexcept {
  std::byte unexpected{};
  const ssize_t got = ::recv(socket_.get(), &unexpected, sizeof unexpected, MSG_DONTWAIT | MSG_PEEK);
  return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

LinkWait LinkClient::wait(std::chrono::milliseconds timeout) noexcept {
  if (!attached()) {
    return LinkWait::closed;
  }
  const bool news = ilk_link_wait_snapshot(kernel_, lock_read_, static_cast<std::uint32_t>(timeout.count()));
  if (__atomic_load_n(&kernel_->generation, __ATOMIC_RELAXED) != generation_) {
    return LinkWait::closed;
  }
  if (news) {
    return LinkWait::snapshot;
  }
  return peer_alive() ? LinkWait::timeout : LinkWait::closed;
}

bool LinkClient::read_snapshot(ilk_snapshot_t& snapshot) noexcept {
  return attached() && ilk_link_read_snapshot(kernel_, &snapshot, &lock_read_);
}

bool LinkClient::read_event(ilk_event_t& event) noexcept {
  return attached() && ilk_link_next_event(kernel_, &events_read_, &events_lost_, &event);
}

std::uint32_t LinkClient::send(ilk_request_t request) noexcept {
  if (!attached()) {
    return 0;
  }
  request.sequence = std::max(sequence_ + 1, 1u);
  request.crc = ilk_request_crc(&request);
  if (!ilk_link_put_request(kernel_, app_, &request)) {
    return 0;
  }
  sequence_ = request.sequence;
  return sequence_;
}

void LinkClient::publish_seen(std::uint32_t tick) noexcept {
  if (attached()) {
    ilk_link_set_seen_tick(app_, tick);
  }
}

}  // namespace interlock
