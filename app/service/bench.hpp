/**
 * @file
 * The simulated hardware as the interface offers it, with the dead man's switch of its pedal.
 */
#pragma once

#include <optional>
#include <string>

#include "motion/deadman_timer.hpp"
#include "motion/realtime_channel.hpp"
#include "service/bench_client.hpp"
#include "service/reply.hpp"

namespace interlock {

class Bench {
 public:
  /** For which a pedal stays down without a renewal. */
  static constexpr std::chrono::milliseconds pedal_timeout{500};

  /** An empty `socket_path` means that the hardware is real. */
  Bench(const boost::asio::any_io_executor& executor, const std::string& socket_path);

  /** 404 NO_BENCH when the hardware is real. */
  [[nodiscard]] tl::expected<void, Problem> need_simulated() const;

  /**
   * Passes a command of models/plant/README.md on. 404 NO_BENCH when the hardware is real, 409 PEDAL_LAPSED
   * when a pedal is renewed that is not held, 422 INVALID when the plant refuses, 503 NO_BENCH when it is
   * silent.
   *
   * @param session who presses, when it is the pedal
   */
  boost::asio::awaitable<Reply> command(std::string name, nlohmann::json fields, const ControlView& view,
                                        std::uint32_t session);

  /** Since when the simulated hardware is connected, as far as it answers now; nothing when it does not. */
  boost::asio::awaitable<std::optional<UtcTime>> connected_since();

  /** Releases a pedal that is held over the network; `why`: a sentence, for whoever renews it later. */
  boost::asio::awaitable<void> release_pedal(std::string why);

  /** Whether the pedal is held, and not renewed in time. */
  [[nodiscard]] bool overdue(const ControlView& view) const;

  /** Whether that session holds the pedal. */
  [[nodiscard]] bool held_by(std::uint32_t session) const { return pedal_.held() && presser_ == session; }

 private:
  tl::expected<void, Problem> take_pedal(nlohmann::json& fields, const ControlView& view,
                                         std::uint32_t session);

  std::optional<BenchClient> client_;
  DeadmanTimer pedal_{pedal_timeout};
  std::uint32_t presser_ = 0;                                   /**< session that pressed last */
  std::string came_up_ = "Nobody has pressed the bench pedal."; /**< why it is not held */
};

}  // namespace interlock
