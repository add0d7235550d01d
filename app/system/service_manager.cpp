#include "system/service_manager.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace interlock {
namespace {

constexpr std::uint32_t tells_a_watchdog = 4;
constexpr ilk_service_notify_t nobody{-1, 0};

}  // namespace

tl::expected<ServiceManager, std::string> ServiceManager::connect() {
  ilk_service_notify_t notify{};
  if (!ilk_service_notify_open(&notify)) {
    return tl::make_unexpected("the service manager at $NOTIFY_SOCKET cannot be reached: " +
                               std::generic_category().message(errno));
  }
  return ServiceManager(notify);
}

ServiceManager::ServiceManager(ServiceManager&& other) noexcept
    : notify_(std::exchange(other.notify_, nobody)), told_(other.told_) {}

ServiceManager::~ServiceManager() {
  ilk_service_notify_send(&notify_, "STOPPING=1");
  ilk_service_notify_close(&notify_);
}

void ServiceManager::say_ready() const { ilk_service_notify_send(&notify_, "READY=1"); }

std::chrono::milliseconds ServiceManager::pause() const {
  return std::chrono::milliseconds(notify_.watchdog_ms / tells_a_watchdog);
}

void ServiceManager::say_alive(std::uint32_t work_done) {
  if (std::exchange(told_, work_done) != work_done) {
    ilk_service_notify_send(&notify_, "WATCHDOG=1");
  }
}

}  // namespace interlock
