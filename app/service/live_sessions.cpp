#include "service/live_sessions.hpp"

#include <algorithm>
#include <set>

#include "store/digest.hpp"

namespace interlock {
namespace {

constexpr std::chrono::seconds store_uses_after{60};
constexpr std::size_t token_length = 43;

/** What one sweep has to do in the store. */
struct Upkeep {
  std::vector<Session> uses;
  std::set<std::uint32_t> known;
  std::map<std::uint32_t, AuditEntry> to_end;
  UtcTime now;

  /** Returns the numbers of the known sessions that have ended. */
  Stored<std::vector<std::uint32_t>> operator()(Store& store) const {
    return store.transact([this](Transaction& transaction) -> Stored<std::vector<std::uint32_t>> {
      Sessions sessions(transaction);
      Audit audit(transaction);
      for (const Session& used : uses) {
        sessions.touch(used.number, used.last_seen);
      }
      for (const auto& [number, record] : to_end) {
        if (sessions.end(number)) {
          audit.append(record);
        }
      }
      for (const Session& over : sessions.end_expired(now)) {
        audit.append(session_ended(over, "expired", now));
      }
      std::vector<std::uint32_t> gone;
      std::ranges::copy_if(known, std::back_inserter(gone),
                           [&](std::uint32_t number) { return !sessions.find(number, now); });
      return gone;
    });
  }
};

}  // namespace

AuditEntry session_ended(const Session& session, const std::string& reason, UtcTime now) {
  return {.time = now,
          .tick = std::nullopt,
          .actor = session.user.name,
          .session = session.number,
          .kind = AuditKind::session_ended,
          .detail = {{"reason", reason}}};
}

std::optional<Session> LiveSessions::find_at_hand(const std::string& token) {
  const auto found = number_of_token_.find(sha256_hex(token));
  if (found == number_of_token_.end()) {
    return std::nullopt;
  }
  const std::uint32_t number = found->second;
  auto session = known(number);
  if (session) {
    touch(number);
  }
  return session;
}

boost::asio::awaitable<tl::expected<std::optional<Session>, Problem>> LiveSessions::find(std::string token) {
  if (token.size() != token_length) {
    co_return std::nullopt;
  }
  if (auto session = find_at_hand(token)) {
    co_return session;
  }
  auto work = [token, now = clocks_.utc()](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<std::optional<Session>> {
      return Sessions(transaction).find(token, now);
    });
  };
  const auto stored = co_await store_.run(std::move(work));
  if (!stored) {
    co_return tl::make_unexpected(stored.error());
  }
  if (!*stored || to_end_.contains((*stored)->number)) {
    co_return std::nullopt;
  }
  live_.try_emplace((*stored)->number, live(**stored));
  number_of_token_[sha256_hex(token)] = (*stored)->number;
  co_return find_at_hand(token);
}

std::optional<Session> LiveSessions::known(std::uint32_t number) const {
  const auto found = live_.find(number);
  const bool lives = found != live_.end() && !is_over(found->second);
  return lives ? std::optional(found->second.session) : std::nullopt;
}

void LiveSessions::add(const NewSession& opened) {
  live_[opened.session.number] = live(opened.session);
  number_of_token_[sha256_hex(opened.token)] = opened.session.number;
}

void LiveSessions::touch(std::uint32_t number) {
  const auto found = live_.find(number);
  if (found != live_.end() && !is_over(found->second)) {
    found->second.session.last_seen = clocks_.utc();
    found->second.used = clocks_.steady();
  }
}

void LiveSessions::note_peer(std::uint32_t number, const std::string& peer) {
  if (const auto found = live_.find(number); found != live_.end()) {
    found->second.peer = peer;
  }
}

std::optional<std::string> LiveSessions::peer_of(std::uint32_t number) const {
  const auto found = live_.find(number);
  const bool any = found != live_.end() && !found->second.peer.empty();
  return any ? std::optional(found->second.peer) : std::nullopt;
}

void LiveSessions::forget(const std::vector<Session>& ended) {
  for (const Session& each : ended) {
    drop(each.number);
  }
}

void LiveSessions::end(std::uint32_t number, const AuditEntry& record) {
  to_end_.try_emplace(number, record);
  drop(number);
}

std::optional<std::chrono::steady_clock::duration> LiveSessions::idle(std::uint32_t number) const {
  const auto found = live_.find(number);
  if (found == live_.end() || is_over(found->second)) {
    return std::nullopt;
  }
  return clocks_.steady() - found->second.used;
}

LiveSessions::Live LiveSessions::live(const Session& session) const {
  const UtcTime now = clocks_.utc();
  const SteadyTime passing = clocks_.steady();
  const auto idle = std::max(now - session.last_seen, UtcTime::duration::zero());
  return {session, session.last_seen, passing - idle, passing + (session.expires() - now)};
}

bool LiveSessions::is_over(const Live& live) const {
  const SteadyTime now = clocks_.steady();
  return now >= live.ends || now - live.used >= session_idle_limit;
}

void LiveSessions::drop(std::uint32_t number) {
  if (live_.erase(number) != 0) {
    std::erase_if(number_of_token_, [&](const auto& each) { return each.second == number; });
    listener_(number);
  }
}

/** In the store, too, which has only the clock and may think that they live. */
void LiveSessions::drop_those_over() {
  std::vector<Session> over;
  for (const auto& [number, live] : live_) {
    if (is_over(live)) {
      over.push_back(live.session);
    }
  }
  for (const Session& each : over) {
    end(each.number, session_ended(each, "expired", clocks_.utc()));
  }
}

/** Seldom enough for the disk, and always before the store would end a session that was used since. */
std::vector<Session> LiveSessions::uses_to_store(UtcTime now) const {
  std::vector<Session> uses;
  for (const auto& [number, live] : live_) {
    const bool due = live.session.last_seen - live.seen_stored >= store_uses_after ||
                     now + store_uses_after >= live.seen_stored + session_idle_limit;
    if (due && live.session.last_seen > live.seen_stored) {
      uses.push_back(live.session);
    }
  }
  return uses;
}

boost::asio::awaitable<void> LiveSessions::sweep() {
  const UtcTime now = clocks_.utc();
  drop_those_over();
  Upkeep work{uses_to_store(now), {}, to_end_, now};
  for (const auto& [number, live] : live_) {
    work.known.insert(number);
  }
  Upkeep sent = work;
  const auto gone = co_await store_.run(std::move(sent));
  if (!gone) {
    co_return;
  }
  for (const auto& [number, record] : work.to_end) {
    to_end_.erase(number);
  }
  for (const Session& used : work.uses) {
    if (const auto found = live_.find(used.number); found != live_.end()) {
      found->second.seen_stored = used.last_seen;
    }
  }
  for (const std::uint32_t number : *gone) {
    drop(number);
  }
}

}  // namespace interlock
