#include "service/store_executor.hpp"

#include <spdlog/spdlog.h>

#include <string>

#include "system/as_result.hpp"

namespace interlock {
namespace {

namespace asio = boost::asio;

bool is_failure(const StoreError& error) {
  return error.kind == StoreError::Kind::unavailable || error.kind == StoreError::Kind::newer ||
         error.kind == StoreError::Kind::damaged;
}

StoreError failure(std::string problem) {
  return {StoreError::Kind::unavailable, std::move(problem), "", "",
          "see what else uses the store, and whether the disk is full or slow"};
}

std::pair<Status, const char*> answer_to(StoreError::Kind kind) {
  switch (kind) {
    case StoreError::Kind::invalid:
      return {Status::unprocessable_entity, "INVALID"};
    case StoreError::Kind::exists:
      return {Status::conflict, "EXISTS"};
    case StoreError::Kind::not_found:
      return {Status::not_found, "NOT_FOUND"};
    case StoreError::Kind::last_admin:
      return {Status::conflict, "LAST_ADMIN"};
    case StoreError::Kind::session_over:
      return {Status::unauthorized, "LOGIN"};
    case StoreError::Kind::role:
      return {Status::forbidden, "ROLE"};
    case StoreError::Kind::no_memory:
      return {Status::service_unavailable, "OVERLOADED"};
    case StoreError::Kind::outdated:
    case StoreError::Kind::unavailable:
    case StoreError::Kind::newer:
    case StoreError::Kind::damaged:
      break;
  }
  return {Status::service_unavailable, "STORE"};
}

}  // namespace

Problem problem_of(const StoreError& error) {
  const auto [status, code] = answer_to(error.kind);
  return {.status = status,
          .code = code,
          .detail = error.problem + ".",
          .field = error.field,
          .expected = error.expected,
          .next_step = error.next_step};
}

StoreExecutor::StoreExecutor(boost::asio::any_io_executor network, Store& store,
                             std::chrono::milliseconds timeout)
    : network_(std::move(network)), store_(store), timeout_(timeout) {}

StoreExecutor::~StoreExecutor() {
  asio::post(pool_, [this] { (void)write_notes(); });
  pool_.join();
}

Stored<void> StoreExecutor::may_commit(CommitToken& order, const Stored<void>& noted) {
  if (!noted) {
    return noted;
  }
  if (!order.begin_commit()) {
    return tl::make_unexpected(failure("nobody waits for the change any more"));
  }
  return {};
}

asio::awaitable<void> StoreExecutor::patiently(Wait& wait) const {
  wait.timer.expires_after(timeout_);
  co_await wait.timer.async_wait(as_result);
  if (!wait.done && !wait.order.abandon()) {
    wait.timer.expires_after(timeout_);
    co_await wait.timer.async_wait(as_result);
  }
}

Problem StoreExecutor::too_late(const CommitToken& order) {
  const std::string waited = std::to_string(timeout_.count()) + " ms";
  if (order.abandoned()) {
    const StoreError error = failure("the store did not answer within " + waited + "; nothing was changed");
    watch(&error);
    return problem_of(error);
  }
  StoreError error = failure("the disk has not confirmed the change for " + waited +
                             "; whether it is kept is not known yet");
  watch(&error);
  error.next_step = "look whether it is there before you try again";
  return problem_of(error);
}

void StoreExecutor::note(AuditEntry entry) {
  if (!notes_.add(std::move(entry))) {
    spdlog::error("the store does not take the audit's records: some are lost");
    return;
  }
  send_notes();
}

/** At most one batch is on its way, so that the records stay in their order. */
void StoreExecutor::send_notes() {
  if (std::exchange(sending_, true)) {
    return;
  }
  // After what the network thread is doing now, which may note more.
  asio::post(network_, [this] {
    asio::post(pool_, [this] {
      asio::post(network_, [this, written = write_notes()] {
        sending_ = false;
        watch(written ? nullptr : &written.error());
        if (written && !notes_.empty()) {
          send_notes();
        }
      });
    });
  });
}

/** In the store's thread. What could not be written goes out again with the next record or note. */
Stored<void> StoreExecutor::write_notes() {
  AuditNotes::Batch batch = notes_.take();
  if (batch.empty()) {
    return {};
  }
  const auto append = [&](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<void> {
      Audit audit(transaction);
      for (const AuditEntry& entry : batch) {
        audit.append(entry);
      }
      return {};
    });
  };
  Stored<void> written = caught(append);
  if (written) {
    notes_.confirm();
  } else {
    notes_.give_back(std::move(batch));
  }
  return written;
}

/** The log hears of a failure once, and of its end. */
void StoreExecutor::watch(const StoreError* error) {
  const bool failing = error != nullptr && is_failure(*error);
  if (failing && !failing_) {
    spdlog::error("the store fails: {}; changes are refused until it works", error->message());
  } else if (!failing && failing_) {
    spdlog::warn("the store works again");
  }
  failing_ = failing;
}

}  // namespace interlock
