/**
 * @file
 * Connections of OpenIGTLink: who is connected, what comes from them, what waits for them.
 *
 * Belongs to the network thread. What a message means is none of its business: it hands messages over one by
 * one and sends what it is told. A peer is closed that breaks the framing, begins a message and does not end
 * it, does not take what is sent to it, or sends nothing although it has to.
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "igtl/frame.hpp"
#include "igtl/message.hpp"

namespace interlock::igtl {

/** What a connection may do. */
enum class Role : std::uint8_t { observer, controller };

/** As the interface spells it. */
constexpr const char* role_word(Role role) noexcept {
  return role == Role::controller ? "controller" : "observer";
}

/** Number of a connection; never given twice. */
using PeerId = std::uint32_t;

/** Where the server listens, and whom it lets in. */
struct IgtlServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 18944;     /**< 0: any free one */
  std::vector<std::string> allow; /**< addresses of peers; empty: those of this machine */
  /** Silence after which the controller counts as lost. Zero: that of one which had sent something regularly
   * (IgtlServer::heartbeat_gap), and only while something may move. */
  std::chrono::milliseconds controller_silence{0};
};

/** The messages of one name that came from a peer. */
struct Heard {
  std::string type; /**< of the last one */
  std::uint64_t count = 0;
  std::chrono::steady_clock::time_point last;
  std::optional<std::chrono::steady_clock::duration> interval; /**< between the last two */
};

/** A connection, as others see it. */
struct Peer {
  PeerId id = 0;
  std::string address;    /**< and port */
  std::uint16_t port = 0; /**< of this app, that it came to */
  Role role = Role::observer;
  std::uint16_t version = 1; /**< of the header in which it is answered */
  std::chrono::system_clock::time_point since;
  std::map<std::string, Heard> heard; /**< by name; the names that came first */
  std::uint64_t received = 0;
  std::uint64_t sent = 0;
  std::uint64_t refused = 0;  /**< messages that were skipped or unwanted */
  std::uint64_t replaced = 0; /**< values that a newer one overtook before they were sent */
  std::optional<std::chrono::microseconds> round_trip; /**< as TCP measures it */
};

/** Listens, keeps the connections, and passes on what they ask and are told. */
class IgtlServer {
 public:
  /** What the connections run on. */
  using Executor = boost::asio::any_io_executor;

  static constexpr std::size_t capacity = 16;
  /** Replies that wait for one peer; one more, and it is closed. */
  static constexpr std::size_t backlog = 256;
  /** Names of one peer that are told apart. */
  static constexpr std::size_t most_names = 64;
  /** From its first byte to its last. */
  static constexpr std::chrono::milliseconds message_timeout{1000};
  /** With a peer that does not take what is sent to it. */
  static constexpr std::chrono::milliseconds write_timeout{1000};
  /** With a peer whose framing broke, to take the last answer. */
  static constexpr std::chrono::milliseconds parting_timeout{100};
  /** How long the loss of a controller's machine goes unnoticed while something is sent to it. */
  static constexpr std::chrono::milliseconds controller_timeout{200};
  /** While something may move: without an acknowledgement of what was sent. TCP by itself looks only when it
   * repeats, first after 200 ms. */
  static constexpr std::chrono::milliseconds acknowledgement_timeout{150};
  /** A controller sends regularly when no two messages were further apart... */
  static constexpr std::chrono::milliseconds heartbeat_gap{150};
  /** ...for this long. */
  static constexpr std::chrono::milliseconds heartbeat_proof{2000};
  /** Its silence by which it counts as lost. */
  static constexpr std::chrono::milliseconds heartbeat_silence{200};
  static constexpr std::chrono::milliseconds beat_period{25};
  /** Messages of one peer in a `rate_window`; what comes beyond waits in its connection. */
  static constexpr std::size_t most_messages = 100;
  static constexpr std::chrono::milliseconds rate_window{100};

  explicit IgtlServer(const Executor& executor) : acceptor_(executor) {}

  /** Starts to listen; the error names address, port and what to do. Other addresses than this machine's are
   * granted only with a list of the peers that may come. */
  tl::expected<void, std::string> listen(const IgtlServerOptions& options);

  /** Port that was granted; 0 while it does not listen. */
  [[nodiscard]] std::uint16_t port() const { return port_; }

  /** Accepts and serves connections; ends with the io_context. */
  boost::asio::awaitable<void> accept();

  /** Connects to a peer that listens, and again when that fails or ends; ends with the io_context. */
  boost::asio::awaitable<void> keep_connected(boost::asio::ip::tcp::endpoint peer,
                                              std::chrono::milliseconds pause);

  /** Looks after deadlines; ends with the io_context. */
  boost::asio::awaitable<void> heartbeat();

  /** Told of each connection, its messages, those that are skipped, and its end with the reason. */
  std::function<void(PeerId)> on_open = [](PeerId) {};
  /** Told of a STOP among what was read and has to wait for its turn. */
  std::function<void()> on_stop_ahead = [] {};
  /** Told before that of the socket, which may be looked at for as long as the connection lives. */
  std::function<void(int, std::weak_ptr<const void>)> on_socket = [](int, const std::weak_ptr<const void>&) {
  };
  std::function<void(PeerId, const Message&)> on_message = [](PeerId, const Message&) {};
  std::function<void(PeerId, const Header&, const FaultAt&)> on_refused = [](PeerId, const Header&,
                                                                             const FaultAt&) {};
  std::function<void(const Peer&, const std::string&)> on_close = [](const Peer&, const std::string&) {};

  /** The clock of the timeouts; tests set their own, because their machine may be late. */
  std::function<std::chrono::steady_clock::time_point()> read_clock = std::chrono::steady_clock::now;

  /** Asked whether something may move, hence whether it matters that the controller hangs. */
  std::function<bool()> is_in_motion = [] { return false; };

  /** Sends in order and drops nothing. */
  void reply(PeerId to, const std::string& device, const Body& body);

  /** Sends the newest value: one of that type and name that still waits is replaced. */
  void show(PeerId to, const std::string& device, const Body& body);

  /** Counts a message that was understood and is unwanted. */
  void count_refusal(PeerId id);

  /** False when there is no such connection. */
  bool set_role(PeerId id, Role role);

  /** Ends a connection; false when there is none of that number. */
  bool disconnect(PeerId id, const std::string& reason);

  /** The connection of that number, if it is open. */
  [[nodiscard]] std::optional<Peer> find(PeerId id) const;

  /** Oldest first. */
  [[nodiscard]] std::vector<Peer> peers() const;

  [[nodiscard]] bool empty() const { return sessions_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;
  using Tcp = boost::asio::ip::tcp;

  struct Session {
    Session(Tcp::socket connected, PeerId id, Clock::time_point now);

    Tcp::socket socket;
    boost::asio::steady_timer news; /**< cancelled when there is something to send, or to end */
    boost::asio::steady_timer pause;
    Peer peer;
    FrameReader reader;
    std::deque<ByteVector> replies;
    std::map<std::pair<std::string, std::string>, ByteVector> newest; /**< by type and name */
    std::pair<std::string, std::string> shown_last;                   /**< of `newest`: each has its turn */
    Clock::time_point last_heard;
    Clock::time_point regular_since;                       /**< without a long gap */
    std::optional<Clock::time_point> unacknowledged_since; /**< something that was sent */
    std::optional<Clock::time_point> message_since;        /**< a message has begun */
    std::optional<Clock::time_point> write_since;          /**< something is being sent */
    std::optional<Clock::time_point> parting_since;        /**< nothing that comes is heard any more */
    Clock::time_point window_since;
    std::size_t in_window = 0;
    bool open = true;
    std::string reason = "the peer closed the connection"; /**< why it is not */
  };
  using SessionPointer = std::shared_ptr<Session>;

  [[nodiscard]] bool is_welcome(const boost::asio::ip::address& address) const;
  void admit(Tcp::socket socket);
  boost::asio::awaitable<void> serve(SessionPointer session);
  boost::asio::awaitable<void> read(SessionPointer session);
  boost::asio::awaitable<void> part(SessionPointer session, std::string reason);
  boost::asio::awaitable<void> write(SessionPointer session);
  boost::asio::awaitable<void> slow_down(SessionPointer session, Bytes unread);
  void take(Session& session, Frame frame);
  void refuse(Session& session, const Header& header, const FaultAt& fault);
  void note_sign_of_life(Session& session);
  void check_timeouts(Session& session, Clock::time_point now) const;
  void check_controller(Session& session, Clock::time_point now) const;
  static Clock::duration unacknowledged(Session& session, Clock::time_point now);
  static void close(Session& session, const std::string& reason);
  static void set_timeout(Session& session, std::chrono::milliseconds timeout);
  [[nodiscard]] SessionPointer session_of(PeerId id) const;
  [[nodiscard]] static Peer seen(const Session& session);

  Tcp::acceptor acceptor_;
  std::vector<boost::asio::ip::address> allow_;
  std::chrono::milliseconds controller_silence_{0};
  std::uint16_t port_ = 0;
  std::list<SessionPointer> sessions_; /**< oldest first */
  PeerId last_id_ = 0;
};

}  // namespace interlock::igtl
