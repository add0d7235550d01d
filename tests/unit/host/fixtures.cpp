#include "fixtures.hpp"

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "interlock/kernel.h"

namespace interlock::host_test {

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "ilk-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot create a temporary directory");
  }
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() { std::filesystem::remove_all(path_); }

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  reset();
  number_ = other.release();
  return *this;
}

int Descriptor::release() { return std::exchange(number_, -1); }

void Descriptor::reset() {
  if (number_ >= 0) {
    close(release());
  }
}

ilk_config_t one_axis_config() {
  ilk_config_t config{};
  config.common.version = ILK_CONFIG_VERSION;
  config.common.size_bytes = sizeof(ilk_config_t);
  config.common.period_us = 1000;
  config.common.pedal_channels = 2;
  config.common.app_timeout_ticks = 100;
  config.common.lease_max_ticks = 100;
  config.common.pedal_debounce_ticks = 10;
  config.common.pedal_disagree_ticks = 50;
  config.common.power_up_ticks = 20;
  config.common.switch_debounce_ticks = 5;
  config.common.bad_frame_limit = 3;
  config.common.overrun_limit = 3;
  ilk_axis_config_t& axis = config.axis[0];
  axis.card = ILK_CARD_NON_PWM;
  axis.motor_direction = 1;
  axis.limit_side = ILK_LIMIT_NONE;
  axis.min_counts = -1000;
  axis.max_counts = 1000;
  axis.coast_counts = 12;
  axis.backlash_counts = 1;
  axis.noise_counts = 1;
  axis.deadband_counts = 1;
  axis.dead_zone_drive = 1967;
  axis.max_drive = 0x1FFFF;
  axis.unhomed_max_drive = 0x1FFFF / 10;
  axis.unhomed_travel_counts = 160;
  axis.full_speed_counts_per_s = 1000;
  axis.stall_ticks = 500;
  axis.stall_effort_ticks = 68;
  axis.stall_min_counts = 2;
  axis.reverse_counts = 20;
  axis.drift_counts = 20;
  axis.rest_ticks = 50;
  axis.max_delta_counts = 8;
  config.crc = ilk_config_crc(&config);
  return config;
}

std::optional<Descriptor> connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  Descriptor connected(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (connect(connected.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return std::nullopt;
  }
  return connected;
}

namespace {

void* map(int descriptor, size_t bytes, int protection) {
  void* address = mmap(nullptr, bytes, protection, MAP_SHARED, descriptor, 0);
  return address == MAP_FAILED ? nullptr : address;
}

}  // namespace

std::unique_ptr<App> App::attach(const std::string& link, uint32_t word) {
  std::optional<Descriptor> connected = connect_to(link);
  if (!connected) {
    return nullptr;
  }
  auto app = std::unique_ptr<App>(new App);
  app->socket = std::move(*connected);
  std::array<int, 2> descriptors{-1, -1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof descriptors)> control{};
  iovec body{&app->hello, sizeof app->hello};
  msghdr message{};
  message.msg_iov = &body;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  if (recvmsg(app->socket.get(), &message, MSG_CMSG_CLOEXEC) != static_cast<ssize_t>(sizeof app->hello)) {
    return nullptr;
  }
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header == nullptr || header->cmsg_len != CMSG_LEN(sizeof descriptors)) {
    return nullptr;
  }
  std::memcpy(descriptors.data(), CMSG_DATA(header), sizeof descriptors);
  app->kernel_region_descriptor = Descriptor(descriptors[0]);
  app->app_region_descriptor = Descriptor(descriptors[1]);
  app->kernel = static_cast<const ilk_link_kernel_region_t*>(
      map(descriptors[0], sizeof(ilk_link_kernel_region_t), PROT_READ));
  app->app = static_cast<ilk_link_app_region_t*>(
      map(descriptors[1], sizeof(ilk_link_app_region_t), PROT_READ | PROT_WRITE));
  return send(app->socket.get(), &word, sizeof word, MSG_NOSIGNAL) == sizeof word ? std::move(app) : nullptr;
}

App::~App() {
  if (kernel != nullptr) {
    munmap(const_cast<ilk_link_kernel_region_t*>(kernel), sizeof *kernel);
  }
  if (app != nullptr) {
    munmap(app, sizeof *app);
  }
}

bool eventually(const std::function<bool()>& attempt) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!attempt()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

}  // namespace interlock::host_test
