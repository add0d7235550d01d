#include "kernel_side.hpp"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <stdexcept>

namespace interlock::test {
namespace {

void require(bool holds, const char* what) {
  if (!holds) {
    throw std::runtime_error(what);
  }
}

}  // namespace

KernelSide::KernelSide() : listener_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  require(socket().size() < sizeof address.sun_path, "socket path too long");
  std::strcpy(address.sun_path, socket().c_str());
  require(::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0, "bind");
  require(::listen(listener_.get(), 4) == 0, "listen");
  hello.magic = ILK_LINK_MAGIC;
  hello.version = ILK_LINK_VERSION;
  hello.layout_hash = ilk_link_layout_hash();
  hello.kernel_region_bytes = sizeof(ilk_link_kernel_region_t);
  hello.app_region_bytes = sizeof(ilk_link_app_region_t);
}

FileDescriptor KernelSide::make_region(std::size_t bytes) {
  FileDescriptor region(::memfd_create("region", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  require(::ftruncate(region.get(), static_cast<off_t>(bytes)) == 0, "ftruncate");
  if (seal) {
    require(::fcntl(region.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0, "seal");
  }
  return region;
}

void KernelSide::accept() {
  connection_ = FileDescriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  require(static_cast<bool>(connection_), "accept");
  kernel_fd_ = make_region(sizeof(ilk_link_kernel_region_t));
  app_fd_ = make_region(sizeof(ilk_link_app_region_t));
  kernel_mapping_ =
      SharedMapping(kernel_fd_, sizeof(ilk_link_kernel_region_t), SharedMapping::Access::read_write);
  app_mapping_ = SharedMapping(app_fd_, sizeof(ilk_link_app_region_t), SharedMapping::Access::read_write);
  kernel_ = static_cast<ilk_link_kernel_region_t*>(kernel_mapping_.data());
  app_ = static_cast<ilk_link_app_region_t*>(app_mapping_.data());
  hello.generation = ++generation_;
  kernel_->magic = ILK_LINK_MAGIC;
  kernel_->version = ILK_LINK_VERSION;
  kernel_->layout_hash = ilk_link_layout_hash();
  kernel_->generation = generation_;

  iovec buffer{&hello, hello_bytes};
  const std::array<int, 2> fds{kernel_fd_.get(), app_fd_.get()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof fds)> control{};
  msghdr message{};
  message.msg_iov = &buffer;
  message.msg_iovlen = 1;
  if (descriptors != 0) {
    message.msg_control = control.data();
    message.msg_controllen = CMSG_SPACE(descriptors * sizeof(int));
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(descriptors * sizeof(int));
    std::memcpy(CMSG_DATA(header), fds.data(), descriptors * sizeof(int));
  }
  require(::sendmsg(connection_.get(), &message, MSG_NOSIGNAL) == static_cast<ssize_t>(hello_bytes),
          "sendmsg");
}

void KernelSide::close() { connection_ = FileDescriptor(); }

void KernelSide::bump_lock() { __atomic_fetch_add(&kernel_->snapshot_lock, 1, __ATOMIC_ACQ_REL); }

void KernelSide::publish(const ilk_snapshot_t& snapshot) {
  begin_write();
  const auto* from = reinterpret_cast<const std::uint32_t*>(&snapshot);
  auto* to = reinterpret_cast<std::uint32_t*>(&kernel_->snapshot);
  for (std::size_t i = 0; i < sizeof snapshot / sizeof *from; ++i) {
    __atomic_store_n(&to[i], from[i], __ATOMIC_RELAXED);
  }
  end_write();
  ::syscall(SYS_futex, &kernel_->snapshot_lock, FUTEX_WAKE, 4, nullptr, nullptr, 0);
}

void KernelSide::push_event(const ilk_event_t& event) {
  const std::uint32_t head = kernel_->event_head;
  ilk_event_t& place = kernel_->event[head % ILK_LINK_EVENTS];
  __atomic_store_n(&place.number, 0, __ATOMIC_RELEASE);
  place.kind = event.kind;
  place.tick = event.tick;
  std::memcpy(place.value, event.value, sizeof place.value);
  __atomic_store_n(&place.number, head + 1, __ATOMIC_RELEASE);
  __atomic_store_n(&kernel_->event_head, head + 1, __ATOMIC_RELEASE);
}

void KernelSide::push_verdict(const ilk_request_t& request, std::uint32_t verdict, std::uint32_t tick) {
  push_event({0, ILK_EVENT_VERDICT, tick, {request.sequence, request.kind, request.axis, verdict}});
}

std::optional<ilk_request_t> KernelSide::take_request() {
  const std::uint32_t tail = kernel_->request_tail;
  if (__atomic_load_n(&app_->request_head, __ATOMIC_ACQUIRE) == tail) {
    return std::nullopt;
  }
  const ilk_request_t request = app_->request[tail % ILK_LINK_REQUESTS];
  __atomic_store_n(&kernel_->request_tail, tail + 1, __ATOMIC_RELEASE);
  return request;
}

}  // namespace interlock::test
