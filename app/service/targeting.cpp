#include "service/targeting.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "service/fields.hpp"
#include "system/printable.hpp"
#include "targeting/registration.hpp"
#include "targeting/registration_doubt.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** A number of the probe: how the interface calls it, and where it is kept. */
struct Offset {
  const char* name;
  double Targeting::* value;
};

constexpr std::array<Offset, 5> offsets{{
    {"treatment_to_tip_offset", &Targeting::treatment_to_tip_mm},
    {"robot_to_entry_offset", &Targeting::robot_to_entry_mm},
    {"cannula_to_treatment_offset", &Targeting::cannula_to_treatment_mm},
    {"canula_to_treatment_offset", &Targeting::cannula_to_treatment_mm},
    {"treatment_to_robot_at_home", &Targeting::treatment_to_robot_at_home_mm},
}};

std::string element(const std::string& name, std::size_t row, std::size_t column) {
  return name + "[" + std::to_string(4 * row + column) + "]";
}

double at(const RowMajor& pose, std::size_t row, std::size_t column) { return pose[4 * row + column]; }

/** Element of R^T R. */
double gram(const RowMajor& pose, std::size_t one, std::size_t other) {
  double sum = 0.0;
  for (std::size_t row = 0; row < 3; ++row) {
    sum += at(pose, row, one) * at(pose, row, other);
  }
  return sum;
}

double determinant(const RowMajor& pose) {
  const auto minor = [&](std::size_t one, std::size_t other) {
    return at(pose, 1, one) * at(pose, 2, other) - at(pose, 1, other) * at(pose, 2, one);
  };
  return at(pose, 0, 0) * minor(1, 2) - at(pose, 0, 1) * minor(0, 2) + at(pose, 0, 2) * minor(0, 1);
}

void check_last_row(Fields& fields, const std::string& name, const RowMajor& pose) {
  if (at(pose, 0, 3) == 0.0 && at(pose, 1, 3) == 0.0 && at(pose, 2, 3) == 0.0 && at(pose, 3, 3) == 1.0 &&
      (at(pose, 3, 0) != 0.0 || at(pose, 3, 1) != 0.0 || at(pose, 3, 2) != 0.0)) {
    fields.reject(name, "looks transposed: its last row is an origin",
                  "row after row, 0 0 0 1 as the last row");
  }
  for (std::size_t column = 0; column < 4; ++column) {
    const double expected = column == 3 ? 1.0 : 0.0;
    if (at(pose, 3, column) != expected) {
      fields.reject(element(name, 3, column), "is not " + std::to_string(static_cast<int>(expected)),
                    "0 0 0 1 as the last row");
    }
  }
}

void check_origin(Fields& fields, const std::string& name, const RowMajor& pose) {
  for (std::size_t row = 0; row < 3; ++row) {
    if (std::abs(at(pose, row, 3)) > farthest_mm) {
      fields.reject(element(name, row, 3), "is too far away", "a position from -10000 to 10000 mm");
    }
  }
}

/** Written so that anything that is no number fails, too. */
void check_rotation(Fields& fields, const std::string& name, const RowMajor& pose) {
  for (std::size_t one = 0; one < 3; ++one) {
    for (std::size_t other = one; other < 3; ++other) {
      const double expected = one == other ? 1.0 : 0.0;
      if (!(std::abs(gram(pose, one, other) - expected) <= entered_rigidity)) {
        const std::string columns = std::to_string(one + 1) + " and " + std::to_string(other + 1);
        fields.reject(name,
                      one == other ? "has a column " + std::to_string(one + 1) + " whose length is not 1"
                                   : "has columns " + columns + " that are not perpendicular",
                      "a rotation: R^T R = 1 within 0.001");
      }
    }
  }
  if (!(std::abs(determinant(pose) - 1.0) <= 3 * entered_rigidity)) {
    fields.reject(name,
                  "mirrors: its determinant is not +1, as of left-handed axes, or of one with the wrong sign",
                  "a rotation: determinant +1");
  }
}

std::optional<RowMajor> read_pose(Fields& fields, const std::string& name) {
  const auto numbers = fields.numbers(name, std::tuple_size_v<RowMajor>);
  if (!numbers) {
    return std::nullopt;
  }
  RowMajor pose{};
  std::copy(numbers->begin(), numbers->end(), pose.begin());
  check_last_row(fields, name, pose);
  check_origin(fields, name, pose);
  check_rotation(fields, name, pose);
  return pose;
}

std::optional<Point> read_point(Fields& fields, const std::string& name) {
  const auto numbers = fields.numbers(name, std::tuple_size_v<Point>);
  if (!numbers) {
    return std::nullopt;
  }
  Point point{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    point[i] = (*numbers)[i];
    if (std::abs(point[i]) > farthest_mm) {
      fields.reject(name + "[" + std::to_string(i) + "]", "is too far away",
                    "a number from -10000 to 10000 mm");
    }
  }
  return point;
}

/** None, or as many as a registration needs. */
std::vector<Point> read_points(Fields& fields, const std::string& name) {
  std::vector<Point> points;
  const json* list = fields.value(name);
  if (list == nullptr) {
    return points;
  }
  const bool is_counted = list->is_array() && std::ssize(*list) <= most_fiducials &&
                          (list->empty() || std::ssize(*list) >= fewest_fiducials);
  if (!is_counted) {
    fields.reject(name, "is no list of fiducials", "a list of 3 to 1000 points, or an empty one");
    return points;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = name + "[" + std::to_string(i) + "]";
    const json body{{"point", (*list)[i]}};
    Fields each(body, {"point"}, fields.place_of(place));
    points.push_back(read_point(each, "point").value_or(Point{}));
    fields.adopt(each);
  }
  return points;
}

/** How well a registration fits the points by which it was found. */
void read_fit(Fields& fields, Targeting& targeting) {
  targeting.residual_mm = fields.number("residual_mm", 0.0, largest_residual_mm);
  targeting.fiducials = fields.integer("fiducials", fewest_fiducials, most_fiducials);
  targeting.fiducial_points = read_points(fields, "fiducial_points");
  const auto count = static_cast<std::int64_t>(targeting.fiducial_points.size());
  if (count != 0 && targeting.fiducials.value_or(count) != count) {
    fields.reject("fiducial_points", "are not as many as fiducials says", "a point for each fiducial");
  } else if (count != 0) {
    targeting.fiducials = count;
  }
}

/** Of the target point: symmetric, and negative in no direction. */
std::optional<std::array<double, 9>> read_covariance(Fields& fields, const std::string& name) {
  const auto numbers = fields.numbers(name, std::tuple_size_v<std::array<double, 9>>);
  if (!numbers) {
    return std::nullopt;
  }
  std::array<double, 9> covariance{};
  std::ranges::copy(*numbers, covariance.begin());
  const Eigen::Matrix3d matrix(covariance.data());
  const double largest = matrix.cwiseAbs().maxCoeff();
  const double rounding = 1e-9 * largest;
  if (!(largest <= largest_variance_mm2) ||
      !((matrix - matrix.transpose()).cwiseAbs().maxCoeff() <= rounding) ||
      !(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues().minCoeff() >= -rounding)) {
    fields.reject(name, "is no covariance",
                  "a symmetric matrix without a negative eigenvalue, entries of at most 10000 mm²");
  }
  return covariance;
}

/** Each name once. */
std::vector<PlannedTarget> read_planned(Fields& fields, const std::string& name) {
  std::vector<PlannedTarget> planned;
  const json* list = fields.value(name);
  if (list != nullptr && (!list->is_array() || list->size() > most_planned_targets)) {
    fields.reject(name, "is no list of targets",
                  "a list of at most " + std::to_string(most_planned_targets) + " targets");
    return planned;
  }
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const std::string place = name + "[" + std::to_string(i) + "]";
    Fields each((*list)[i], {"name", "entry_point", "target_point"}, fields.place_of(place));
    each.require({{"name", "a name"}, {"entry_point", "3 numbers"}, {"target_point", "3 numbers"}});
    PlannedTarget target{.name = each.line("name", longest_target_name).value_or(""),
                         .entry_point = read_point(each, "entry_point").value_or(Point{}),
                         .target_point = read_point(each, "target_point").value_or(Point{})};
    const auto looks_the_same = [seen = visible(target.name)](const PlannedTarget& other) {
      return visible(other.name) == seen;
    };
    if (std::ranges::any_of(planned, looks_the_same)) {
      each.reject("name", "is " + target.name + ", which comes twice", "each name once");
    }
    fields.adopt(each);
    planned.push_back(std::move(target));
  }
  return planned;
}

json planned_json(const std::vector<PlannedTarget>& planned) {
  json list = json::array();
  for (const PlannedTarget& each : planned) {
    list.push_back(
        {{"name", each.name}, {"entry_point", each.entry_point}, {"target_point", each.target_point}});
  }
  return list;
}

void read_offsets(Fields& fields, Targeting& targeting) {
  for (const Offset& offset : offsets) {
    if (const auto value = fields.number(offset.name, -largest_offset_mm, largest_offset_mm)) {
      targeting.*offset.value = *value;
    }
  }
}

tl::expected<Targeting, Problem> unless_wrong(const Fields& fields, const Targeting& targeting) {
  if (fields.problem()) {
    return tl::make_unexpected(*fields.problem());
  }
  return targeting;
}

template <typename Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json();
}

/** Null stands for what was never set. */
json without_nulls(const json& stored) {
  json values = json::object();
  for (const auto& [name, value] : stored.items()) {
    if (!value.is_null()) {
      values[name] = value;
    }
  }
  return values;
}

}  // namespace

double registration_distance(const RowMajor& one, const RowMajor& other, bool ignores_rotation) {
  constexpr double same_mm = 2.0;
  constexpr double same_turn = 0.0175;
  double distance = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const bool is_origin = i % 4 == 3;
    if (is_origin || !ignores_rotation) {
      distance = std::max(distance, std::abs(one[i] - other[i]) / (is_origin ? same_mm : same_turn));
    }
  }
  return distance;
}

Targeting judged(Targeting targeting, const InForce& in_force) {
  const bool is_past = targeting.registration_epoch == 0 || targeting.registration_epoch != in_force.epoch;
  const std::string& reason =
      targeting.registration_expired.empty() && is_past ? in_force.reason : targeting.registration_expired;
  targeting.present_epoch = in_force.epoch;
  if (targeting.case_problem.empty() && targeting.case_number != in_force.open_case) {
    targeting.case_problem = "The case is suspended: something interrupted it, as a start of the app does.";
  }
  targeting.registration_problem = targeting.case_problem;
  if (targeting.registration && !reason.empty()) {
    targeting.registration_problem += (targeting.case_problem.empty() ? "" : " ");
    targeting.registration_problem += "The registration has expired: " + reason;
  } else if (!targeting.registration && targeting.case_problem.empty()) {
    targeting.registration_problem = "The registration is not set.";
  }
  return targeting;
}

json to_json(const Targeting& targeting) {
  const auto or_nothing = [](const std::string& text) { return text.empty() ? json() : json(text); };
  json body = to_stored(targeting);
  const bool is_valid = targeting.registration_problem.empty();
  body["case"] = targeting.case_number == 0 ? json() : json(targeting.case_number);
  body["registration_state"] = is_valid                                                   ? "valid"
                               : !targeting.registration                                  ? "not_set"
                               : targeting.registration_problem == targeting.case_problem ? "suspended"
                                                                                          : "expired";
  body["registration_problem"] = or_nothing(targeting.registration_problem);
  body["registration_doubt"] = or_nothing(targeting.registration_doubt);
  body["override_reason"] = or_nothing(targeting.override_reason);
  body.erase("registration_epoch");
  body.erase("registration_expired");
  return body;
}

json to_stored(const Targeting& targeting) {
  json body{{"registration", or_null(targeting.registration)},
            {"registration_epoch", targeting.registration_epoch},
            {"registration_expired", targeting.registration_expired},
            {"registration_doubt", targeting.registration_doubt},
            {"override_reason", targeting.override_reason},
            {"ignore_registration_rotation", targeting.ignore_registration_rotation},
            {"residual_mm", or_null(targeting.residual_mm)},
            {"fiducials", or_null(targeting.fiducials)},
            {"fiducial_points", targeting.fiducial_points},
            {"entry_point", or_null(targeting.entry_point)},
            {"target_point", or_null(targeting.target_point)},
            {"target_covariance_mm2", or_null(targeting.target_covariance_mm2)},
            {"planned_targets", planned_json(targeting.planned_targets)},
            {"reported_position", or_null(targeting.reported_position)}};
  for (const Offset& offset : offsets) {
    body[offset.name] = targeting.*offset.value;
  }
  return body;
}

tl::expected<Targeting, Problem> stored_targeting(const json& stored) {
  const json values = stored.is_object() ? without_nulls(stored) : stored;
  Targeting targeting;
  Fields fields(values,
                {"registration", "registration_epoch", "registration_expired", "registration_doubt",
                 "override_reason", "ignore_registration_rotation", "residual_mm", "fiducials",
                 "fiducial_points", "entry_point", "target_point", "target_covariance_mm2", "planned_targets",
                 "reported_position", "treatment_to_tip_offset", "robot_to_entry_offset",
                 "cannula_to_treatment_offset", "canula_to_treatment_offset", "treatment_to_robot_at_home"},
                "targeting");
  targeting.registration = read_pose(fields, "registration");
  targeting.registration_epoch = fields.integer("registration_epoch", 0, latest_epoch).value_or(0);
  targeting.registration_expired = fields.text("registration_expired").value_or("");
  targeting.registration_doubt = fields.text("registration_doubt").value_or("");
  targeting.override_reason = fields.text("override_reason").value_or("");
  targeting.ignore_registration_rotation = fields.boolean("ignore_registration_rotation").value_or(false);
  read_fit(fields, targeting);
  targeting.entry_point = read_point(fields, "entry_point");
  targeting.target_point = read_point(fields, "target_point");
  targeting.target_covariance_mm2 = read_covariance(fields, "target_covariance_mm2");
  targeting.planned_targets = read_planned(fields, "planned_targets");
  targeting.reported_position = read_pose(fields, "reported_position");
  read_offsets(fields, targeting);
  return unless_wrong(fields, targeting);
}

tl::expected<Targeting, Problem> with_registration(Targeting targeting, const json& body) {
  Fields fields(body, {"registration", "ignore_registration_rotation", "residual_mm", "fiducials",
                       "fiducial_points", "override_reason"});
  fields.require({{"registration", "16 numbers, row-major"}});
  targeting.registration = read_pose(fields, "registration");
  targeting.registration_epoch = targeting.present_epoch;
  targeting.registration_expired.clear();
  targeting.override_reason = fields.line("override_reason", longest_reason).value_or("");
  targeting.ignore_registration_rotation = fields.boolean("ignore_registration_rotation").value_or(false);
  read_fit(fields, targeting);
  return unless_wrong(fields, targeting);
}

/** More than the distance by which a motion may miss; empty where it is not, or nobody knows it. */
std::string doubt_of_residual(const Targeting& targeting, const Robot& robot) {
  const double most_mm = robot.targeting.tolerance_mm;
  if (!targeting.residual_mm || *targeting.residual_mm <= most_mm) {
    return "";
  }
  return "Its residual is " + json(*targeting.residual_mm).dump() + " mm, and a motion may miss by " +
         json(most_mm).dump() + " mm at most.";
}

tl::expected<Targeting, Problem> plausible(Targeting targeting, const Robot& robot) {
  const auto registration =
      Registration::create(*targeting.registration, targeting.ignore_registration_rotation);
  const auto doubt =
      robot.kinematics && registration
          ? registration_doubt(robot.targeting.registration, registration->scanner_from_zframe())
          : std::nullopt;
  const std::string residual = doubt_of_residual(targeting, robot);
  targeting.registration_doubt = doubt.value_or("") + (doubt && !residual.empty() ? " " : "") + residual;
  if (targeting.registration_doubt.empty()) {
    targeting.override_reason.clear();
  } else if (targeting.override_reason.empty()) {
    return fail(
        Problem{.status = Status::unprocessable_entity,
                .code = "IMPLAUSIBLE",
                .detail = "The registration can hardly be right. " + targeting.registration_doubt,
                .expected = "the robot's zFrame in the scanner, RAS, mm, where the robot's file expects it",
                .next_step = "Send it in RAS and mm. A person may set it all the same, with a reason."});
  }
  return targeting;
}

tl::expected<Targeting, Problem> with_reported_pose(Targeting targeting, const json& body) {
  Fields fields(body, {"current_position"});
  fields.require({{"current_position", "16 numbers, row-major"}});
  targeting.reported_position = read_pose(fields, "current_position");
  return unless_wrong(fields, targeting);
}

tl::expected<Targeting, Problem> with_target(Targeting targeting, const json& body) {
  Fields fields(body, {"entry_point", "target_point", "target_covariance_mm2", "treatment_to_tip_offset",
                       "robot_to_entry_offset", "cannula_to_treatment_offset", "canula_to_treatment_offset",
                       "treatment_to_robot_at_home"});
  if (fields.has("cannula_to_treatment_offset") && fields.has("canula_to_treatment_offset")) {
    fields.reject("canula_to_treatment_offset", "and cannula_to_treatment_offset are the same",
                  "one of them");
  }
  if (const auto entry = read_point(fields, "entry_point")) {
    targeting.entry_point = entry;
  }
  if (const auto target = read_point(fields, "target_point")) {
    targeting.target_point = target;
    targeting.target_covariance_mm2.reset();
  }
  if (fields.has("target_covariance_mm2")) {
    fields.require({{"target_point", "the point that it is of"}});
    targeting.target_covariance_mm2 = read_covariance(fields, "target_covariance_mm2");
  }
  read_offsets(fields, targeting);
  return unless_wrong(fields, targeting);
}

tl::expected<Targeting, Problem> with_planned_targets(Targeting targeting, const json& body) {
  Fields fields(body, {"planned_targets"});
  fields.require({{"planned_targets", "a list of targets"}});
  targeting.planned_targets = read_planned(fields, "planned_targets");
  return unless_wrong(fields, targeting);
}

tl::expected<Targeting, Problem> without_target(Targeting targeting, const json& /*body*/) {
  targeting.entry_point.reset();
  targeting.target_point.reset();
  targeting.target_covariance_mm2.reset();
  return targeting;
}

std::vector<Point> points_of(const Targeting& targeting) {
  std::vector<Point> points;
  for (const auto& point : {targeting.entry_point, targeting.target_point}) {
    if (point) {
      points.push_back(*point);
    }
  }
  for (const PlannedTarget& each : targeting.planned_targets) {
    points.insert(points.end(), {each.entry_point, each.target_point});
  }
  return points;
}

tl::expected<RowMajor, Problem> rigid_pose(const json& body, const std::string& name) {
  Fields fields(body, {name.c_str()});
  const auto pose = read_pose(fields, name);
  if (fields.problem()) {
    return tl::make_unexpected(*fields.problem());
  }
  return *pose;
}

void aim_at(Targeting& targeting, const RowMajor& pose) {
  constexpr double usual_depth_mm = 50.0;
  double depth_mm = usual_depth_mm;
  if (targeting.entry_point && targeting.target_point) {
    const Point& from = *targeting.entry_point;
    const Point& to = *targeting.target_point;
    depth_mm = std::max(1.0, std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
  }
  targeting.target_point = {pose[3], pose[7], pose[11]};
  targeting.target_covariance_mm2.reset();
  targeting.entry_point = {pose[3] - depth_mm * pose[2], pose[7] - depth_mm * pose[6],
                           pose[11] - depth_mm * pose[10]};
}

}  // namespace interlock
