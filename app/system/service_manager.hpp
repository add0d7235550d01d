/**
 * @file
 * The service manager that started the app, if one did.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "interlock/service_notify.h"

namespace interlock {

class ServiceManager {
 public:
  /** Connects to it; the reason when one is named that cannot be reached. */
  static tl::expected<ServiceManager, std::string> connect();

  ServiceManager(ServiceManager&& other) noexcept;
  ServiceManager& operator=(ServiceManager&&) = delete;

  /** Says that the app ends. */
  ~ServiceManager();

  /** The app serves from now on. */
  void say_ready() const;

  /** How often it wants to hear of the work; 0: it does not watch. */
  [[nodiscard]] std::chrono::milliseconds pause() const;

  /** Says that the app lives if work has been done since this was last called. */
  void say_alive(std::uint32_t work_done);

 private:
  explicit ServiceManager(const ilk_service_notify_t& notify) : notify_(notify) {}

  ilk_service_notify_t notify_;
  std::uint32_t told_ = 0;
};

}  // namespace interlock
