#include "http/context.hpp"

#include "http/problems.hpp"
#include "robot/catalog.hpp"

namespace interlock::web {

const ControlView& Context::view() const {
  const ControlView& newest = control.view();
  book.follow(newest);
  return newest;
}

tl::expected<void, Problem> Context::need_kernel() const {
  if (!view().attached) {
    return fail(no_kernel("No kernel is connected."));
  }
  return {};
}

boost::asio::awaitable<Reply> Context::ask_kernel(std::uint32_t kind, std::uint32_t slot,
                                                  std::string where) const {
  const auto kernel = need_kernel();
  if (!kernel) {
    co_return fail(kernel.error());
  }
  const auto answer = co_await control.ask(kind, slot);
  if (!answer || !answer->verdict) {
    co_return fail(no_kernel("The kernel did not answer within a second."));
  }
  if (*answer->verdict != ILK_VERDICT_ACCEPTED) {
    co_return fail(refused(verdict_refusal(*answer->verdict, where)));
  }
  co_return Success{
      Status::ok,
      {{"verdict", catalog::name(catalog::Family::verdict, *answer->verdict)}, {"tick", answer->tick}}};
}

}  // namespace interlock::web
