#include "service/axis_requests.hpp"

#include "robot/catalog.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using catalog::Family;
using nlohmann::json;

json not_sent(const Axis& axis, const std::string& reason) {
  return {{"slot", axis.slot}, {"axis", axis.name}, {"verdict", nullptr}, {"detail", "Not sent: " + reason}};
}

json verdict_row(const AxisRequest& request, const std::optional<KernelResponse>& answer) {
  json row{{"slot", request.axis->slot}, {"axis", request.axis->name}, {"verdict", nullptr}};
  if (!answer || !answer->verdict) {
    row["detail"] = "The kernel did not answer within a second. Look at the position before trying again.";
    return row;
  }
  row["verdict"] = catalog::name(Family::verdict, *answer->verdict);
  if (*answer->verdict != ILK_VERDICT_ACCEPTED) {
    const Refusal refusal = verdict_refusal(*answer->verdict, request.axis->name);
    row["detail"] = refusal.detail + (refusal.next_step.empty() ? "" : " " + refusal.next_step);
  }
  return row;
}

}  // namespace

boost::asio::awaitable<json> ask_each(const Context& context, const Caller& caller,
                                      std::vector<AxisRequest> requests) {
  json rows = json::array();
  std::string blocking;
  for (const AxisRequest& request : requests) {
    if (blocking.empty() && !context.motion_control.held_by(caller.session)) {
      blocking = "control was lost meanwhile.";
    }
    const std::string& reason = request.not_sent_because.empty() ? blocking : request.not_sent_because;
    if (!reason.empty()) {
      rows.push_back(not_sent(*request.axis, reason));
      continue;
    }
    const auto answer = co_await context.control.ask(request.kind, request.axis->slot, request.target_counts);
    rows.push_back(verdict_row(request, answer));
    if (!answer || !answer->verdict) {
      blocking = "the kernel did not answer before.";
    }
  }
  co_return rows;
}

}  // namespace interlock
