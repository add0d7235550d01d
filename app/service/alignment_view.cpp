#include "service/alignment_view.hpp"

#include <array>
#include <cstdio>
#include <numbers>

#include "targeting/guide_frame.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock {
namespace {

using nlohmann::json;

tl::unexpected<json> unknown(const char* code, const std::string& text) {
  return tl::unexpected(json{{"code", code}, {"text", text}});
}

json problem_of(const KinematicsError& error) { return to_json(error); }

Eigen::Vector3d vector(const Point& point) { return Eigen::Vector3d(point.data()); }

}  // namespace

ProbeOffsets probe_of(const Targeting& targeting) {
  return {targeting.treatment_to_tip_mm, targeting.robot_to_entry_mm, targeting.cannula_to_treatment_mm,
          targeting.treatment_to_robot_at_home_mm};
}

ImageAccuracy accuracy_of(const Targeting& targeting) {
  ImageAccuracy accuracy;
  if (targeting.residual_mm && !targeting.fiducial_points.empty() &&
      !targeting.ignore_registration_rotation) {
    accuracy.registration = RegistrationFit{*targeting.residual_mm, {}};
    for (const Point& each : targeting.fiducial_points) {
      accuracy.registration->fiducials_mm.push_back(vector(each));
    }
  }
  if (targeting.target_covariance_mm2) {
    accuracy.target_mm2 = Eigen::Matrix3d(targeting.target_covariance_mm2->data());
  }
  return accuracy;
}

namespace {

Known<Alignment> alignment_of(const Robot& robot, const Targeting& targeting, const PoseSetup& setup) {
  if (!targeting.entry_point || !targeting.target_point) {
    return unknown("NO_TARGET", "Entry and target are not both set.");
  }
  const EntryTarget aim{vector(*targeting.entry_point), vector(*targeting.target_point), 0.0,
                        accuracy_of(targeting)};
  return align(robot, setup.kinematics, setup.registration, aim).map_error(problem_of);
}

Known<AxisPositions> positions_of(const Robot& robot, const ControlView& view) {
  if (!view.attached) {
    return unknown("NO_KERNEL", "The app is not connected to the kernel.");
  }
  return known_positions(robot, view.snapshot.state);
}

Known<Pose> current_of(const Robot& robot, const ControlView& view, const PoseSetup& setup) {
  return positions_of(robot, view).and_then([&](const AxisPositions& positions) {
    return setup.kinematics.zframe_from_treatment(positions)
        .map([&](const Pose& pose) { return setup.registration.scanner_from_zframe() * pose; })
        .map_error(problem_of);
  });
}

}  // namespace

namespace {

/** With the identity where there is no valid registration. */
Known<PoseSetup> any_setup(const Robot& robot, const Targeting& targeting) {
  constexpr RowMajor identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const bool is_valid = targeting.registration_problem.empty();
  const RowMajor pose = is_valid ? targeting.registration.value_or(identity) : identity;
  return RobotKinematics::create(robot, probe_of(targeting))
      .and_then([&](const RobotKinematics& kinematics) {
        return Registration::create(pose, targeting.ignore_registration_rotation)
            .map([&](const Registration& registration) { return PoseSetup{kinematics, registration}; });
      })
      .map_error(problem_of);
}

}  // namespace

Known<PoseSetup> pose_setup(const Robot& robot, const Targeting& targeting) {
  return any_setup(robot, targeting).and_then([&](PoseSetup setup) -> Known<PoseSetup> {
    if (robot.kinematics && !targeting.registration_problem.empty()) {
      return unknown("NO_REGISTRATION", targeting.registration_problem);
    }
    return setup;
  });
}

Known<PictureSetup> picture_setup(const Robot& robot, const Targeting& targeting) {
  return any_setup(robot, targeting).map([&](const PoseSetup& setup) {
    return PictureSetup{setup, targeting.registration_problem.empty() ? "scanner" : "robot"};
  });
}

Known<AxisPositions> known_positions(const Robot& robot, const ilk_state_t& state) {
  AxisPositions positions;
  std::string missing;
  for (const Axis& axis : robot.axes) {
    const ilk_axis_t& found = state.axis[axis.slot];
    positions.push_back(axis.to_unit(found.position_counts));
    if (found.homed == 0 && !axis.role.empty()) {
      missing += (missing.empty() ? "" : ", ") + axis.title;
    }
  }
  if (!missing.empty()) {
    return unknown("NOT_HOMED", "Where the robot is, is not known before these are homed: " + missing + ".");
  }
  return positions;
}

Known<json> body_view(const PoseSetup& setup, const AxisPositions& positions) {
  const auto listed = [&](const Eigen::Vector3d& zframe_mm) -> json {
    const Eigen::Vector3d point = setup.registration.scanner_from_zframe() * zframe_mm;
    return {point.x(), point.y(), point.z()};
  };
  return setup.kinematics.zframe_body(positions)
      .map([&](const RobotBody& body) {
        json parts = json::array();
        for (const BodyPart& part : body) {
          parts.push_back({{"name", part.name}, {"from", listed(part.from_mm)}, {"to", listed(part.to_mm)}});
        }
        return parts;
      })
      .map_error(problem_of);
}

json alignment_view(const Robot& robot, const Targeting& targeting, const ControlView& view) {
  const Known<PoseSetup> setup = pose_setup(robot, targeting);
  const auto alignment =
      setup.and_then([&](const PoseSetup& with) { return alignment_of(robot, targeting, with); });
  const auto current = setup.and_then([&](const PoseSetup& with) { return current_of(robot, view, with); });
  const auto picture = picture_setup(robot, targeting);
  const auto body = picture.and_then([&](const PictureSetup& with) {
    return positions_of(robot, view).and_then([&](const AxisPositions& positions) {
      return body_view(with.poses, positions);
    });
  });
  json answer{{"frame", picture ? picture->frame : "scanner"},
              {"alignment", nullptr},
              {"alignment_problem", nullptr},
              {"current", nullptr},
              {"current_problem", nullptr},
              {"current_body", body.value_or(json())},
              {"current_body_problem", body ? json() : body.error()},
              {"current_deviation", nullptr}};
  if (alignment) {
    answer["alignment"] = to_json(robot, *alignment);
  } else {
    answer["alignment_problem"] = alignment.error();
  }
  if (current) {
    answer["current"] = row_major(*current);
  } else {
    answer["current_problem"] = current.error();
  }
  if (alignment && current) {
    answer["current_deviation"] = to_json(deviation(*current, alignment->desired));
  }
  return answer;
}

RobotPoses robot_poses(const Robot& robot, const Targeting& targeting, const ControlView& view) {
  RobotPoses poses;
  const Known<PoseSetup> setup = pose_setup(robot, targeting);
  if (!setup) {
    return poses;
  }
  if (const auto alignment = alignment_of(robot, targeting, *setup)) {
    poses.desired = row_major(alignment->desired);
    poses.setpoints = alignment->setpoints;
  }
  if (const auto current = current_of(robot, view, *setup)) {
    poses.current = row_major(*current);
  }
  return poses;
}

tl::expected<NeedleTarget, Problem> needle_target(const Robot& robot, const Targeting& targeting,
                                                  const ControlView& view) {
  return pose_setup(robot, targeting)
      .and_then([&](const PoseSetup& with) -> Known<NeedleTarget> {
        if (!targeting.target_point) {
          return unknown("NO_TARGET", "The target is not set.");
        }
        return positions_of(robot, view)
            .and_then([&](const AxisPositions& positions) {
              return zframe_from_guide(robot, with.kinematics, positions).map_error(problem_of);
            })
            .map([&](const Pose& zframe_from_guide) {
              const Pose pose = with.registration.scanner_from_zframe() * zframe_from_guide;
              return NeedleTarget{pose, pose.inverse() * vector(*targeting.target_point)};
            });
      })
      .map_error([](const json& problem) {
        return Problem{.status = Status::conflict,
                       .code = problem.at("code"),
                       .detail = problem.at("text"),
                       .expected = "a target, and a robot that is homed and lined up with it",
                       .next_step = "Look at GET /api/targeting/alignment."};
      });
}

std::optional<Problem> out_of_reach(const Robot& robot, const Alignment& alignment,
                                    std::optional<double> accepted_mm, std::optional<double> accepted_deg) {
  // What somebody accepts was rounded when it was shown, to two digits.
  constexpr double rounding = 0.005;
  const TargetingLimits& limits = robot.targeting;
  const double most_mm = accepted_mm ? *accepted_mm + rounding : limits.tolerance_mm;
  const double most_deg = accepted_deg ? *accepted_deg + rounding : limits.tolerance_deg;
  if (is_tolerable(alignment.deviation, most_mm, most_deg)) {
    return std::nullopt;
  }
  const double angle_deg = alignment.deviation.angle_rad * 180.0 / std::numbers::pi;
  std::string clamped;
  for (const AxisSetpoint& setpoint : alignment.setpoints) {
    if (setpoint.clamped) {
      clamped += (clamped.empty() ? "" : ", ") + robot.at_slot(setpoint.slot)->title;
    }
  }
  const auto numbers = [](double mm, double degrees) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.2f mm and %.2f degrees", mm, degrees);
    return std::string(text.data());
  };
  return Problem{.status = Status::conflict,
                 .code = "UNREACHABLE",
                 .detail = "The reachable pose misses the desired one by " +
                           numbers(alignment.deviation.distance_mm, angle_deg) +
                           (clamped.empty() ? "." : "; these axes end before it: " + clamped + "."),
                 .expected = "at most " + numbers(most_mm, most_deg),
                 .next_step = "Set another target, or accept the miss and propose the reachable pose."};
}

tl::expected<Alignment, Problem> alignment_with(const Robot& robot, const Targeting& targeting) {
  return pose_setup(robot, targeting)
      .and_then([&](const PoseSetup& with) { return alignment_of(robot, targeting, with); })
      .map_error([](const json& problem) {
        return Problem{.status = Status::conflict,
                       .code = problem.at("code"),
                       .detail = problem.at("text"),
                       .expected = "entry and target that the robot can reach",
                       .next_step = "Look at GET /api/targeting/alignment, and set others."};
      });
}

}  // namespace interlock
