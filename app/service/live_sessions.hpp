/**
 * @file
 * Who is logged in, at hand for each request: the sessions of the store that were used since the app started.
 *
 * Belongs to the network thread. What the store knows is asked once; its idle times are written back now and
 * then, and a session that somebody else ended there (the command line) ends here within seconds.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "service/clocks.hpp"
#include "service/store_executor.hpp"
#include "store/sessions.hpp"

namespace interlock {

class LiveSessions {
 public:
  /** Is told the number of a session that ended. */
  using Listener = std::function<void(std::uint32_t session)>;

  /** `store` must outlive it. */
  LiveSessions(StoreExecutor& store, Clocks clocks) : store_(store), clocks_(std::move(clocks)) {}

  /** Told of each session that has ended, whatever ended it. */
  void on_end(Listener listener) { listener_ = std::move(listener); }

  /** The living session of that token, which is used thereby; without asking the store. */
  std::optional<Session> find_at_hand(const std::string& token);

  /** As `find_at_hand`, and asks the store for one that is not at hand; 503 STORE while that fails. */
  boost::asio::awaitable<tl::expected<std::optional<Session>, Problem>> find(std::string token);

  /** The living session of that number, if it is at hand. */
  [[nodiscard]] std::optional<Session> known(std::uint32_t number) const;

  /** Whether that session has not ended. */
  [[nodiscard]] bool lives(std::uint32_t number) const { return known(number).has_value(); }

  /** How long ago that session was last used, if it is at hand and lives. */
  [[nodiscard]] std::optional<std::chrono::steady_clock::duration> idle(std::uint32_t number) const;

  /** A session was opened in the store. */
  void add(const NewSession& opened);

  /** That session was used, for instance by its open stream. */
  void touch(std::uint32_t number);

  /** A request of that session came from there. */
  void note_peer(std::uint32_t number, const std::string& peer);

  /** Where the newest request of that session came from, if there was one since the app started. */
  [[nodiscard]] std::optional<std::string> peer_of(std::uint32_t number) const;

  /** Sessions were ended in the store. */
  void forget(const std::vector<Session>& ended);

  /** A session was ended in the store. */
  void forget(std::uint32_t number) { drop(number); }

  /** Ends a session here at once, and in the store as soon as that works, which `record` will say there. */
  void end(std::uint32_t number, const AuditEntry& record);

  /** Ends what is over, and brings store and memory to agree. */
  boost::asio::awaitable<void> sweep();

 private:
  struct Live {
    Session session;       /**< `last_seen` is its last use */
    UtcTime seen_stored;   /**< `last_seen` in the store */
    SteadyTime used;       /**< when that was, whatever the clock was set to since */
    SteadyTime ends;       /**< at the latest */
    std::string peer = {}; /**< of its newest request; empty: there was none */
  };

  [[nodiscard]] Live live(const Session& session) const;
  [[nodiscard]] bool is_over(const Live& live) const;

  void drop(std::uint32_t number);
  void drop_those_over();
  [[nodiscard]] std::vector<Session> uses_to_store(UtcTime now) const;

  StoreExecutor& store_;
  Clocks clocks_;
  Listener listener_ = [](std::uint32_t) {};
  std::map<std::uint32_t, Live> live_;
  std::map<std::string, std::uint32_t> number_of_token_; /**< by SHA-256 of the token */
  std::map<std::uint32_t, AuditEntry> to_end_;           /**< ended here, not yet in the store */
};

/** Audit record of a session that ended. */
AuditEntry session_ended(const Session& session, const std::string& reason, UtcTime now);

}  // namespace interlock
