#include "http/store_gateway.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <iterator>
#include <memory>

namespace interlock::web {
namespace {

namespace asio = boost::asio;

bool is_failure(const StoreError& error) {
  return error.kind == StoreError::Kind::unavailable || error.kind == StoreError::Kind::newer ||
         error.kind == StoreError::Kind::damaged;
}

Stored<void> append_all(Store& store, const std::vector<AuditEntry>& entries) {
  return store.transact([&](Transaction& transaction) -> Stored<void> {
    Audit audit(transaction);
    for (const AuditEntry& entry : entries) {
      audit.append(entry);
    }
    return {};
  });
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

StoreGateway::StoreGateway(asio::any_io_executor network, Store& store)
    : network_(std::move(network)), store_(store) {}

StoreGateway::~StoreGateway() {
  send_notes();
  pool_.join();
}

asio::awaitable<tl::expected<void, Problem>> StoreGateway::record(AuditEntry entry) {
  return run([entries = std::vector{std::move(entry)}](Store& store) { return append_all(store, entries); });
}

void StoreGateway::note(AuditEntry entry) {
  if (notes_.size() >= most_notes) {
    spdlog::error("the store does not take the audit's records: one more is lost");
    return;
  }
  notes_.push_back(std::move(entry));
  if (!std::exchange(sending_soon_, true)) {
    asio::post(network_, [this] {
      sending_soon_ = false;
      send_notes();
    });
  }
}

void StoreGateway::send_notes() {
  if (notes_.empty()) {
    return;
  }
  asio::post(pool_, [this, notes = std::exchange(notes_, {})]() mutable {
    auto written = append_all(store_, notes);
    asio::post(network_, [this, written, notes = std::move(notes)]() mutable {
      watch(written ? nullptr : &written.error());
      if (!written) {
        take_back(std::move(notes));
      }
    });
  });
}

/** What could not be written goes out again with the next record or note. */
void StoreGateway::take_back(std::vector<AuditEntry> notes) {
  notes.insert(notes.end(), std::move_iterator(notes_.begin()), std::move_iterator(notes_.end()));
  notes_ = std::move(notes);
}

/** The log hears of a failure once, and of its end. */
void StoreGateway::watch(const StoreError* error) {
  const bool failing = error != nullptr && is_failure(*error);
  if (failing && !failing_) {
    spdlog::error("the store fails: {}; changes are refused until it works", error->message());
  } else if (!failing && failing_) {
    spdlog::warn("the store works again");
  }
  failing_ = failing;
}

}  // namespace interlock::web
