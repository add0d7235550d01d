/**
 * @file
 * Why kinematics has no answer. Every function of this folder either answers with finite numbers or with one
 * of these; none throws, and no NaN leaves.
 */
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace interlock {

/** The first quantity outside of its domain. Holds no memory of its own, so that making one allocates
 * nothing; of a family that names its joints itself, it is valid for as long as the robot's kinematics. */
struct KinematicsError {
  /** Kinds of refusal. */
  enum class Code {
    not_finite,    /**< NaN or infinity came in */
    out_of_range,  /**< a number beyond the range in which it means something */
    degenerate,    /**< entry and target too close to say a direction */
    out_of_reach,  /**< no position of the links gets there */
    separation,    /**< the sliders of a trapezoid would leave their window */
    singular,      /**< the approach leaves an angle undetermined */
    not_rigid,     /**< a matrix that is not a rotation and a translation */
    off_axis,      /**< the entry does not lie on the axis of the pose */
    not_converged, /**< the numerical search neither arrived nor showed that there is no way */
    absent,        /**< the robot has no kinematics */
  };

  Code code = Code::not_finite;
  std::string_view quantity;   /**< what, with its unit: "insertion_mm" */
  std::optional<double> value; /**< what came in or would have been needed; empty: not finite */
  double lowest = 0.0;         /**< allowed range of the value, both ends in it */
  double highest = 0.0;

  /** One line for people: what is wrong, the value, the allowed range, what to do. */
  [[nodiscard]] std::string message() const;

  bool operator==(const KinematicsError&) const = default;
};

/** For programs: "NOT_FINITE", "OUT_OF_REACH" and so on. */
std::string_view code_name(KinematicsError::Code code);

/** A value, or why kinematics has none. */
template <typename Value>
using KinematicsResult = tl::expected<Value, KinematicsError>;

}  // namespace interlock
