/**
 * @file
 * The dialect of the later prostate robots and their Slicer module (2024): phases follow each other in a
 * fixed order, a target that is out of reach is moved to what can be reached, and the needle has requests of
 * its own. Unlike there, a request that is forbidden is answered.
 */
#pragma once

#include "igtl/workphases.hpp"

namespace interlock::igtl {

class Wpi2024 final : public Workphases {
 protected:
  [[nodiscard]] std::string forbids(Phase wanted, const RobotState& state) const override;
  [[nodiscard]] bool tells_every_entry() const noexcept override { return true; }
  [[nodiscard]] StatusCode uncalibrated() const noexcept override { return StatusCode::access_denied; }
  [[nodiscard]] bool takes_reachable() const noexcept override { return true; }
  [[nodiscard]] bool takes_target() const noexcept override {
    return phase() == Phase::targeting || phase() == Phase::move_to_target;
  }
  [[nodiscard]] Outgoings after_storing(const Outcome& outcome) const override;
  Reaction take_other(const Message& message, const RobotState& state) override;
  Reaction finish_other(const Wish& wish, const Outcome& outcome) override;

 private:
  Reaction take_text(const std::string& name, const Text& text, const RobotState& state);
  [[nodiscard]] Reaction position(const RobotState& state) const;
  [[nodiscard]] Reaction needle_length(const Text& text) const;
  Reaction retract();
  Reaction needle_tip(const Message& message) const;
};

}  // namespace interlock::igtl
