#include <algorithm>
#include <string>

#include "service/cases.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"

namespace interlock {
namespace {

using nlohmann::json;

/** A refusal of the body is a value here, as the store did not fail. */
struct Changed {
  tl::expected<Targeting, Problem> targeting;
  bool leads_elsewhere = false; /**< than before: what followed from it is stale */
};

/** Whether it is one that was set in another case, or before something moved the robot in the scanner: only a
 * person can know that it holds again, and has perhaps set one since that is at least as near. */
bool is_repeated(Transaction& transaction, const Targeting& after) {
  double to_one_of_before = 2.0;
  double to_one_of_a_person = 2.0;
  for (const KeptRegistration& each : Registrations(transaction).newest_first()) {
    const double distance =
        registration_distance(each.pose, *after.registration, after.ignore_registration_rotation);
    const bool is_of_now = each.epoch == after.registration_epoch && each.case_number == after.case_number;
    if (!is_of_now) {
      to_one_of_before = std::min(to_one_of_before, distance);
    } else if (each.source != source_name(TaskSource::openigtlink)) {
      to_one_of_a_person = std::min(to_one_of_a_person, distance);
    }
  }
  return to_one_of_before <= 1.0 && to_one_of_a_person > to_one_of_before;
}

Problem repeated(const Targeting& before) {
  return {.status = Status::conflict,
          .code = "NO_REGISTRATION",
          .detail = "It is a registration of before, which has expired." +
                    (before.registration ? " " + before.registration_problem : std::string()),
          .expected = "a new registration",
          .next_step = "Register anew, or set it in the console if it still holds."};
}

Problem overtaken(const std::string& problem) {
  return {.status = Status::conflict,
          .code = "NO_REGISTRATION",
          .detail = "It expired while it was set. " + problem,
          .expected = "a registration of now",
          .next_step = "Look whether it still holds, and set it again."};
}

/** A pose that an imager reports moves nothing, nor does a plan. */
bool leads_elsewhere(Targeting before, const Targeting& after) {
  before.reported_position = after.reported_position;
  before.planned_targets = after.planned_targets;
  return before != after;
}

Problem former_point() {
  return {.status = Status::conflict,
          .code = "NO_TARGET",
          .detail = "It has an entry or a target of before the table moved, or of another case.",
          .expected = "points of images that were made since",
          .next_step = "Plan on new images, or set them in the console if they still hold."};
}

/** What moves the robot in the scanner moves the patient, too: points of before are elsewhere. */
Targeting without_points(Targeting targeting) {
  targeting.entry_point.reset();
  targeting.target_point.reset();
  targeting.target_covariance_mm2.reset();
  targeting.planned_targets.clear();
  return targeting;
}

/** Keeps the points that it has and the one before has not; one that a program sends may be no former one. */
tl::expected<void, Problem> keep_points(Transaction& transaction, const Targeting& before,
                                        const Targeting& after, TaskSource source) {
  Points points(transaction);
  const std::vector<Point> known = points_of(before);
  for (const Point& each : points_of(after)) {
    if (std::ranges::find(known, each) != known.end()) {
      continue;
    }
    if (source == TaskSource::openigtlink && points.is_former(after.case_number, each)) {
      return fail(former_point());
    }
    points.add(after.case_number, each);
  }
  return {};
}

Problem no_case(const std::string& problem) {
  return {.status = Status::conflict,
          .code = "NO_CASE",
          .detail = problem,
          .expected = "an open case, to which registration, entry, target and probe belong",
          .next_step = "Open a case, or look at the suspended one and resume it."};
}

}  // namespace

boost::asio::awaitable<tl::expected<Targeting, Problem>> change_targeting(const Context& context,
                                                                          Caller caller, TaskSource source,
                                                                          TargetingChange make, json body) {
  auto keep = [robot = &context.robot, make, body = std::move(body), session = caller.session,
               in_force = context.in_force, hold = context.motion_control.hold(),
               origin = TargetingOrigin{source, caller.peer},
               entry = context.entry(caller, AuditKind::setting, json::object())](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<Changed> {
      if (const auto lives = Sessions(transaction).need(session, Role::engineer, entry.time); !lives) {
        return tl::unexpected(lives.error());
      }
      return find_targeting(transaction, *robot).map([&](const Targeting& stored) -> Changed {
        if (!hold.lasts()) {
          return {fail(control_lost()), false};
        }
        const Targeting before = judged(stored, in_force);
        if (!before.case_problem.empty()) {
          return {fail(no_case(before.case_problem)), false};
        }
        Changed after{make(before, body)};
        if (make == with_registration) {
          after.targeting = std::move(after.targeting).and_then([&](Targeting made) {
            return plausible(std::move(made), *robot);
          });
        }
        if (after.targeting && make == with_registration && origin.source == TaskSource::openigtlink &&
            is_repeated(transaction, *after.targeting)) {
          return {fail(repeated(before)), false};
        }
        if (after.targeting) {
          if (const auto kept = keep_points(transaction, before, *after.targeting, origin.source); !kept) {
            return {fail(kept.error()), false};
          }
        }
        if (after.targeting) {
          after.targeting = judged(std::move(*after.targeting), in_force);
        }
        if (after.targeting && *after.targeting != before) {
          set_targeting(transaction, before, *after.targeting, origin, entry);
          if (make == with_registration) {
            Registrations(transaction)
                .add({after.targeting->case_number, after.targeting->registration_epoch,
                      std::string(source_name(origin.source)), *after.targeting->registration});
          }
          after.leads_elsewhere = leads_elsewhere(before, *after.targeting);
        }
        return after;
      });
    });
  };
  const auto changed = co_await context.store.run(std::move(keep));
  if (!changed) {
    co_return fail(changed.error());
  }
  if (changed->leads_elsewhere) {
    context.registry.end_stale(caller.user);
  }
  if (!changed->targeting) {
    co_return fail(changed->targeting.error());
  }
  Targeting kept = judged(*changed->targeting, context.in_force);
  if (kept.registration_problem.empty()) {
    context.alarms.note_registration("");
  }
  if (make == with_registration && !kept.registration_problem.empty()) {
    co_return fail(overtaken(kept.registration_problem));
  }
  co_return kept;
}

boost::asio::awaitable<tl::expected<void, Problem>> check_points(const Context& context,
                                                                 std::vector<Point> points) {
  auto find = [number = context.in_force.open_case, points = std::move(points)](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<bool> {
      const Points known(transaction);
      return std::ranges::any_of(points, [&](const Point& each) { return known.is_former(number, each); });
    });
  };
  const auto has_former = co_await context.store.run(std::move(find));
  if (!has_former || *has_former) {
    co_return fail(has_former ? former_point() : has_former.error());
  }
  co_return tl::expected<void, Problem>();
}

boost::asio::awaitable<tl::expected<Targeting, Problem>> expire_registration(const Context& context,
                                                                             Caller caller,
                                                                             std::string reason) {
  InForce& in_force = context.in_force;
  const InForce before = in_force;
  in_force.epoch = before.epoch % latest_epoch + 1;
  in_force.reason = reason;
  const bool is_app = caller.session == 0;
  context.registry.end_stale(is_app ? audit_actor::app : caller.user);
  AuditEntry entry = context.entry(caller, AuditKind::setting, json::object());
  entry.actor = is_app ? audit_actor::app : entry.actor;
  auto keep = [robot = &context.robot, is_app, before, after = in_force, reason = std::move(reason),
               origin = TargetingOrigin{TaskSource::console, caller.peer}, entry](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<Targeting> {
      return find_targeting(transaction, *robot).map([&](const Targeting& stored) {
        Targeting expired = is_app ? stored : without_points(stored);
        if (judged(stored, before).registration_problem.empty()) {
          expired.registration_expired = reason;
        }
        if (!is_app) {
          Points(transaction).leave(stored.case_number);
        }
        if (expired != stored) {
          set_targeting(transaction, judged(stored, before), judged(expired, after), origin, entry);
        }
        return expired;
      });
    });
  };
  const auto kept = co_await context.store.run(std::move(keep));
  if (!kept) {
    if (!is_app) {
      put_in_force(context, 0, caller.user);  // its points would outlive the move of the table
    }
    co_return fail(kept.error());
  }
  context.alarms.note_registration(kept->registration_expired);
  co_return judged(*kept, context.in_force);
}

}  // namespace interlock
