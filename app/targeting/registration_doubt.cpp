#include "targeting/registration_doubt.hpp"

#include <array>
#include <cstdio>
#include <numbers>

namespace interlock {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
/** A robot does not stand as near as this to the isocentre, but by chance. */
constexpr double suspiciously_near_mm = 1.0;

/** A mistake, by what undoes it. */
struct Mistake {
  const char* name;
  Pose (*undone)(const Pose&);
};

/** Between LPS and RAS, either way. */
Pose turned_over() {
  Pose pose = Pose::Identity();
  pose.linear().diagonal() = Eigen::Vector3d(-1.0, -1.0, 1.0);
  return pose;
}

Pose scaled(Pose pose, double factor) {
  pose.translation() *= factor;
  return pose;
}

using Mistakes = std::array<Mistake, 4>;

constexpr Mistake none{"", [](const Pose& pose) { return pose; }};
constexpr Mistakes conventions{
    {none,
     {"LPS on both sides", [](const Pose& pose) -> Pose { return turned_over() * pose * turned_over(); }},
     {"LPS in the scanner", [](const Pose& pose) -> Pose { return turned_over() * pose; }},
     {"LPS on the robot", [](const Pose& pose) -> Pose { return pose * turned_over(); }}}};
constexpr std::array<Mistake, 3> units{
    {none,
     {"metres", [](const Pose& pose) { return scaled(pose, 1000.0); }},
     {"centimetres", [](const Pose& pose) { return scaled(pose, 10.0); }}}};
constexpr std::array<Mistake, 3> directions{{none,
                                             {"the inverse", [](const Pose& pose) { return pose.inverse(); }},
                                             {"a transposed rotation", [](const Pose& pose) {
                                                Pose undone = pose;
                                                undone.linear().transposeInPlace();
                                                return undone;
                                              }}}};

Eigen::Vector3d vector(const PointMm& point) { return Eigen::Vector3d(point.data()); }

double turn_deg(const ExpectedRegistration& expected, const Pose& given) {
  const Eigen::Matrix3d usual =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(expected.rotation.data());
  return degrees * Eigen::AngleAxisd(usual.transpose() * given.linear()).angle();
}

/** Of the place within the expected region: 0 in its middle, 1 at the end of the first coordinate. */
double distance_in(const ExpectedRegistration& expected, const Pose& given) {
  return (given.translation() - vector(expected.origin_mm))
      .cwiseQuotient(vector(expected.origin_tolerance_mm))
      .cwiseAbs()
      .maxCoeff();
}

bool is_expected(const ExpectedRegistration& expected, const Pose& given) {
  return distance_in(expected, given) <= 1.0 && turn_deg(expected, given) <= expected.rotation_tolerance_deg;
}

std::string list(const Eigen::Vector3d& point) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "R %.1f, A %.1f, S %.1f mm", point.x(), point.y(), point.z());
  return text.data();
}

std::string whole(double angle_deg) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%.0f degrees", angle_deg);
  return text.data();
}

/** Mistakes that together make a registration out of what could be right. */
struct Suspicion {
  std::string names;
  int mistakes = 0;
  Pose right = Pose::Identity();
  double distance = 0.0;
};

/** The fewest mistakes after which it is as expected, and of these the nearest to the middle. */
std::optional<Suspicion> suspicion_of(const ExpectedRegistration& expected, const Pose& given) {
  std::optional<Suspicion> best;
  for (const Mistake& direction : directions) {
    for (const Mistake& convention : conventions) {
      for (const Mistake& unit : units) {
        Suspicion found;
        found.right = given;
        for (const Mistake* mistake : {&unit, &convention, &direction}) {
          const std::string name = mistake->name;
          found.names += (found.names.empty() || name.empty() ? "" : " and ") + name;
          found.mistakes += name.empty() ? 0 : 1;
          found.right = mistake->undone(found.right);
        }
        found.distance = distance_in(expected, found.right);
        if (found.mistakes > 0 && is_expected(expected, found.right) &&
            (!best || found.mistakes < best->mistakes ||
             (found.mistakes == best->mistakes && found.distance < best->distance))) {
          best = found;
        }
      }
    }
  }
  return best;
}

}  // namespace

std::optional<std::string> registration_doubt(const ExpectedRegistration& expected, const Pose& given) {
  if (given.isApprox(Pose::Identity(), 1e-9)) {
    return "It is the identity, as of a transform that nobody has registered.";
  }
  const bool is_near = given.translation().norm() < suspiciously_near_mm;
  if (is_expected(expected, given) && !(is_near && is_expected(expected, scaled(given, 1000.0)))) {
    return std::nullopt;
  }
  const std::string where = "Its origin is " + list(given.translation()) +
                            ", where the robot's file expects " + list(vector(expected.origin_mm)) +
                            ", each within " + list(vector(expected.origin_tolerance_mm)) +
                            "; it is turned by " + whole(turn_deg(expected, given)) + ", where at most " +
                            whole(expected.rotation_tolerance_deg) + " are expected. ";
  const auto suspicion = suspicion_of(expected, given);
  return where + (suspicion ? "It looks like " + suspicion->names + ": its origin would be " +
                                  list(suspicion->right.translation()) + " in RAS and mm."
                            : "It may belong to another robot, or to one that stands elsewhere.");
}

}  // namespace interlock
