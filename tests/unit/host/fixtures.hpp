/// What several tests of the executive need: a directory that goes away, a valid configuration, an app.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "interlock/link.h"

namespace interlock::host_test {

/// A fresh directory under the system's temporary one, removed with everything in it.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// An open descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] int release();
  void reset();

 private:
  int number_;
};

/// One axis without a switch; everything else as in a real robot.
ilk_config_t one_axis_config();

/// A connected Unix seqpacket socket, or nothing when nobody listens there.
std::optional<Descriptor> connect_to(const std::string& path);

/// An app: the far end of one attachment, with both regions mapped as an app maps them.
class App {
 public:
  /// Connects, waits for the hello, maps and says `word`; nothing when the kernel closes instead.
  static std::unique_ptr<App> attach(const std::string& link, uint32_t word = ILK_LINK_MAGIC);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  ilk_link_hello_t hello{};
  Descriptor socket;
  Descriptor kernel_region_descriptor;
  Descriptor app_region_descriptor;
  const ilk_link_kernel_region_t* kernel = nullptr;
  ilk_link_app_region_t* app = nullptr;

 private:
  App() = default;
};

/// Runs `attempt` until it holds; false after ten seconds, which only a hang can reach.
bool eventually(const std::function<bool()>& attempt);

}  // namespace interlock::host_test
