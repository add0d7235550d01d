/**
 * @file
 * The kernel's end of the link in the test's hands: real socket, real sealed memory, real atomics.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interlock/link.h"
#include "link/shared_mapping.hpp"
#include "temporary_folder.hpp"

namespace interlock::test {

class KernelSide {
 public:
  KernelSide();

  [[nodiscard]] std::string socket() const { return (folder_.path() / "link").string(); }

  /** The hello of the next attachment; a test may spoil it. */
  ilk_link_hello_t hello{};
  bool seal = true;
  std::size_t descriptors = 2;
  std::size_t hello_bytes = sizeof(ilk_link_hello_t);

  /** Makes fresh regions, takes the connection that waits or will come, and sends the hello. */
  void accept();

  /** Makes the regions and the connection's answer ready before anybody connects. */
  void close();

  /** Publishes a snapshot as the kernel does and wakes whoever waits. */
  void publish(const ilk_snapshot_t& snapshot);

  /** Marks the snapshot as being written, or ends that. */
  void begin_write() { bump_lock(); }
  void end_write() { bump_lock(); }

  void push_event(const ilk_event_t& event);
  void push_verdict(const ilk_request_t& request, std::uint32_t verdict, std::uint32_t tick);

  /** Takes the next request out of the ring. */
  std::optional<ilk_request_t> take_request();

  ilk_link_kernel_region_t& kernel() { return *kernel_; }
  ilk_link_app_region_t& app() { return *app_; }

 private:
  void bump_lock();
  FileDescriptor make_region(std::size_t bytes);

  TemporaryFolder folder_;
  FileDescriptor listener_;
  FileDescriptor connection_;
  FileDescriptor kernel_fd_;
  FileDescriptor app_fd_;
  SharedMapping kernel_mapping_;
  SharedMapping app_mapping_;
  ilk_link_kernel_region_t* kernel_ = nullptr;
  ilk_link_app_region_t* app_ = nullptr;
  std::uint32_t generation_ = 0;
};

}  // namespace interlock::test
