/**
 * @file
 * What the app must know of a kind of motion besides how it moves.
 *
 * A kind is a folder below app/modes: `mode.cpp` moves, on the control thread; `kind.cpp` defines
 * `FOLDER_kind()`, which is what this file wants; `drafts.cpp` defines `FOLDER_drafts()`, what people may ask
 * for (service/drafts.hpp); `modes.txt` names the modes of a robot that it serves, with `rates` behind one
 * whose axes need rates. The build collects the folders; nothing else lists them, and one that leaves out a
 * part does not compile.
 */
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "motion/axis_plan.hpp"
#include "motion/mode.hpp"
#include "motion/realtime_channel.hpp"
#include "proposals/check_list.hpp"
#include "proposals/profile.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** What a proposal is judged against. */
struct Scene {
  const Robot& robot;
  const ilk_config_t& config; /**< of the app's robot file */
  const ControlView& view;    /**< the newest */
  /** Targets of moves that were approved and have not ended. */
  std::vector<AxisCounts> headed;
};

/** What differs from kind to kind in the words about a proposal, each a sentence, or what follows in one. */
struct TaskWords {
  std::string waiting;
  std::string executing;
  std::string paused;
  std::string done;
  std::string axis; /**< that the reason is about */
};

/** One kind of motion: everything about it that is not motion itself. */
class MotionKind {
 public:
  virtual ~MotionKind() = default;

  /** As the interface spells it. */
  [[nodiscard]] virtual std::string_view name() const = 0;

  /** The type of its tasks. */
  [[nodiscard]] virtual const std::type_info& tasks() const = 0;

  /** The mode that carries them out. */
  [[nodiscard]] virtual std::unique_ptr<Mode> make_mode(const RobotPlan& plan) const = 0;

  /** The axes that it moves, each once, in the order in which people see them. */
  [[nodiscard]] virtual std::vector<std::uint32_t> slots(const Robot& robot, const Work& work) const = 0;

  /** Judges the work of the proposal, in the kernel's order of checks; notes in the proposal what it found.
   */
  virtual void check(const Scene& scene, Proposal& proposal, CheckList& checks) const = 0;

  /** Whether it moves beside others of its kind, each on its own axis, and not beside anything else. */
  [[nodiscard]] virtual bool yields() const { return false; }

  /** Makes a new proposal complete: its target, or its first step. */
  virtual void begin(const Robot& /*robot*/, Proposal& /*proposal*/) const {}

  /** Takes over what the control thread reports besides the phase. */
  virtual void follow(const Scene& /*scene*/, const TaskStatus& /*status*/, Proposal& /*proposal*/) const {}

  /** What is kept of the work once it has ended; nothing: all of it. */
  [[nodiscard]] virtual std::optional<Work> remains(const Work& /*work*/) const { return std::nullopt; }

  /** The step that runs first. */
  [[nodiscard]] virtual std::uint32_t first_step(const Work& /*work*/) const { return 0; }

  /** What the audit keeps of what was asked for. */
  [[nodiscard]] virtual nlohmann::json asked(const Robot& robot, const Work& work) const = 0;

  /** Adds what only this kind has in schema `Proposal` of spec/openapi.yaml. */
  virtual void add_fields(const Proposal& proposal, nlohmann::json& fields) const = 0;

  /** In words for people. `found`: of the newest biopsy. */
  [[nodiscard]] virtual TaskWords words(const Robot& robot, const Proposal& proposal,
                                        const TaskStatus& status, const BiopsyFindings& found) const = 0;

  /** How the axes will go; the proposal was checked. */
  [[nodiscard]] virtual Profile profile(const Robot& robot, const ilk_config_t& config,
                                        const Proposal& proposal) const = 0;
};

/** Every kind, by the names of the folders. */
std::span<const MotionKind* const> motion_kinds();

/** Their modes, for a robot. */
Modes make_modes(const RobotPlan& plan);

/** What that work is. */
const MotionKind& kind_of(const Work& work);

/** The title of the axis as it reads within a sentence. */
std::string title_of(const Robot& robot, std::uint32_t slot);

/** "yaw, pitch and insertion" */
std::string listed(const Robot& robot, const std::vector<std::uint32_t>& slots);

/** The text with a large first letter. */
std::string capital(std::string text);

/** What to do when the pedal was released; `part`: what was executing. */
std::string paused_words(const std::string& part);

}  // namespace interlock
