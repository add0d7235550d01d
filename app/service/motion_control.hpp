/**
 * @file
 * Control of the robot: the one session that may move it, and those that request to.
 */
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "system/utc_time.hpp"

namespace interlock {

/** A session's hold of control, or its request for it. */
struct Claim {
  std::uint32_t session = 0;
  std::string user;
  UtcTime since;

  bool operator==(const Claim&) const = default;
};

/** Belongs to the network thread. Who may change it is checked by whoever changes it. */
class MotionControl {
 public:
  /** `first_number` is before that of the first hold. It should be no number that an app before may have
   * had: a kernel that runs on would not see that the holder is another one. */
  explicit MotionControl(std::uint32_t first_number) : number_(first_number) {}

  /** A hold of control of which any thread may know whether it lasts, also after the object is gone. */
  class Hold {
   public:
    /** Whether control has not changed hands since. */
    [[nodiscard]] bool lasts() const { return *present_ == number_; }

   private:
    friend class MotionControl;
    explicit Hold(std::shared_ptr<const std::atomic<std::uint32_t>> present)
        : present_(std::move(present)), number_(*present_) {}

    std::shared_ptr<const std::atomic<std::uint32_t>> present_;
    std::uint32_t number_;
  };

  /** Told of each change: of the holder (`holder_changed`), or only of the requests. */
  using Listener = std::function<void(bool holder_changed)>;

  /** Has the listener called after each change of holder or requests. */
  void on_change(Listener listener) { listener_ = std::move(listener); }

  /** Whether that session is in control. */
  [[nodiscard]] bool held_by(std::uint32_t session) const { return holder_ && holder_->session == session; }
  [[nodiscard]] const std::optional<Claim>& holder() const { return holder_; }
  [[nodiscard]] const std::vector<Claim>& requests() const { return requests_; }

  /** The request of that session, or null. */
  [[nodiscard]] const Claim* request_of(std::uint32_t session) const;

  /** Number of the present hold: 0 while nobody is in control, else one that no hold before had. */
  [[nodiscard]] std::uint32_t number() const { return *present_; }

  /** The present hold. */
  [[nodiscard]] Hold hold() const { return Hold(present_); }

  /** Gives control to that session, whoever has it. Its request is granted thereby; nothing changes when it
   * is in control. */
  void give(Claim to);

  /** Notes the request of a session; nothing changes when it has one, or is in control. */
  void request(Claim claim);

  /** Takes hold and request from that session. */
  void release(std::uint32_t session);

  /** Schema `MotionControl` of spec/openapi.yaml, as that session sees it. */
  [[nodiscard]] nlohmann::json shown_to(std::uint32_t session) const;

 private:
  bool drop_request(std::uint32_t session);

  std::optional<Claim> holder_;
  std::vector<Claim> requests_; /**< oldest first */
  std::uint32_t number_;        /**< of the last hold */
  std::shared_ptr<std::atomic<std::uint32_t>> present_ = std::make_shared<std::atomic<std::uint32_t>>(0);
  Listener listener_ = [](bool) {};
};

}  // namespace interlock
