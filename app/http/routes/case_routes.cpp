#include "http/message.hpp"
#include "http/routes.hpp"
#include "service/cases.hpp"
#include "service/fields.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** The text in that field, the only one of the body. */
tl::expected<std::string, Problem> text_in(const Request& request, const char* name, std::size_t longest) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<std::string, Problem> {
    Fields fields(body, {name});
    fields.require({{name, "a text"}});
    const std::string text = fields.line(name, longest).value_or("");
    return fields.problem() ? tl::expected<std::string, Problem>(fail(*fields.problem())) : text;
  });
}

Answering replied(CaseAnswer answering, Status status = Status::ok) {
  auto answer = co_await std::move(answering);
  co_return std::move(answer).map([&](json body) { return Success{status, std::move(body)}; });
}

/** The number in the path; one that is none is of no case. */
std::int64_t number_of(const Call& call) {
  const json body{{"number", call.parameters[0]}};
  return Fields(body, {"number"}).integer("number", 1, latest_epoch).value_or(0);
}

}  // namespace

CaseRoutes::CaseRoutes(const Context& context, Router& router) : context_(context) {
  const auto add = [&](verb method, const std::string& path, const Access& access, auto step) {
    router.add(method, "/api/cases/{number}" + path, access, [this, step](const Call& call) {
      return replied(step(context_, call.caller, number_of(call)));
    });
  };
  router.add(verb::get, "/api/cases", viewers, [this](const Call&) { return replied(list_cases(context_)); });
  router.add(verb::post, "/api/cases", holder, [this](const Call& call) { return open(call); });
  add(verb::get, "", engineers,
      [](const Context& known, const Caller&, std::int64_t number) { return export_case(known, number); });
  add(verb::delete_, "", admins, delete_case);
  add(verb::post, "/suspend", engineers, suspend_case);
  add(verb::post, "/resume", holder, resume_case);
  add(verb::post, "/close", engineers, close_case);
  router.add(verb::post, "/api/cases/{number}/notes", engineers,
             [this](const Call& call) { return add_note(call); });
}

Answering CaseRoutes::open(const Call& call) const {
  auto label = text_in(call.request, "label", 80);
  if (!label) {
    co_return fail(label.error());
  }
  co_return co_await replied(open_case(context_, call.caller, std::move(*label)), Status::created);
}

Answering CaseRoutes::add_note(const Call& call) const {
  auto text = text_in(call.request, "text", 1000);
  if (!text) {
    co_return fail(text.error());
  }
  co_return co_await replied(add_case_note(context_, call.caller, number_of(call), std::move(*text)));
}

}  // namespace interlock::web
