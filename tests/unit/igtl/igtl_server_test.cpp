#include "igtl/igtl_server.hpp"

#include <gmock/gmock.h>
#include <igtlClientSocket.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTransformMessage.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <filesystem>
#include <thread>

#include "bytes.hpp"
#include "igtl/codec.hpp"

namespace interlock::igtl {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::steady_clock;
using testing::HasSubstr;
using namespace std::chrono_literals;

std::size_t open_descriptors() {
  std::size_t count = 0;
  for (const auto& each : std::filesystem::directory_iterator("/proc/self/fd")) {
    count += each.exists() || each.is_symlink() ? 1 : 0;
  }
  return count;
}

/** The server and its peers in one thread: each step of the test lets the network run until something holds.
 */
class IgtlServerTest : public testing::Test {
 protected:
  IgtlServerTest() {
    server_.on_open = [this](PeerId id) { opened_.push_back(id); };
    server_.on_message = [this](PeerId, const Message& message) { messages_.push_back(message); };
    server_.on_refused = [this](PeerId, const Header&, Fault fault) { refused_.push_back(fault); };
    server_.on_close = [this](const Peer&, const std::string& reason) { closed_.push_back(reason); };
    server_.read_clock = [this] { return time_; };
  }

  void start(IgtlServerOptions options = {}) {
    options.port = 0;
    ASSERT_TRUE(server_.listen(options).has_value());
    asio::co_spawn(network_, server_.accept(), asio::detached);
    asio::co_spawn(network_, server_.heartbeat(), asio::detached);
  }

  /** False when it did not come to hold in time. */
  template <typename Condition>
  bool run_until(Condition holds, std::chrono::milliseconds timeout = 4s) {
    const auto end = time_ + timeout;
    while (!holds() && time_ < end) {
      const auto begun = steady_clock::now();
      network_.run_one_for(step);
      time_ += std::min<steady_clock::duration>(steady_clock::now() - begun, step);
    }
    return holds();
  }

  tcp::socket connect() {
    const std::size_t before = opened_.size();
    tcp::socket socket(network_);
    socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
    EXPECT_TRUE(run_until([&] { return opened_.size() > before; }));
    return socket;
  }

  static void send(tcp::socket& socket, const ByteVector& bytes) { asio::write(socket, asio::buffer(bytes)); }

  /** The next message that the server sends. */
  Message receive(tcp::socket& socket, FrameReader& reader) {
    socket.non_blocking(true);
    std::optional<Message> message;
    EXPECT_TRUE(run_until([&] {
      std::array<std::uint8_t, 1> byte{};
      error_code error;
      while (!message && socket.read_some(asio::buffer(byte), error) == 1) {
        for (Arrival& each : test::arrivals(reader, byte)) {
          message = decode(std::get<Frame>(std::move(each))).value();
        }
      }
      return message.has_value();
    }));
    return message.value_or(Message{});
  }

  /** Whether the server closes the connection in time. */
  bool is_closed_within(std::chrono::milliseconds timeout) {
    return run_until([this] { return !closed_.empty(); }, timeout);
  }

  static constexpr auto step = 5ms;

  asio::io_context network_{1};
  /** A clock that is not put forward by what the machine is late. */
  steady_clock::time_point time_ = steady_clock::now();
  IgtlServer server_{network_.get_executor()};
  std::vector<PeerId> opened_;
  std::vector<Message> messages_;
  std::vector<Fault> refused_;
  std::vector<std::string> closed_;
};

const ByteVector hello = write_frame(1, "STRING", "MODE", 0, test::text_body("manual"));

TEST_F(IgtlServerTest, OthersMachinesComeOnlyWithAList) {
  IgtlServerOptions anywhere;
  anywhere.address = "0.0.0.0";
  anywhere.port = 0;
  const auto refused = server_.listen(anywhere);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error(), HasSubstr("list the addresses"));
  anywhere.allow = {"127.0.0.1"};
  EXPECT_TRUE(server_.listen(anywhere).has_value());
  IgtlServer other(network_.get_executor());
  EXPECT_THAT(other.listen({"nowhere", 0, {}, 0ms}).error(), HasSubstr("no address"));
  EXPECT_THAT(other.listen({"127.0.0.1", 0, {"x"}, 0ms}).error(), HasSubstr("\"x\""));
}

TEST_F(IgtlServerTest, APeerThatIsNotOnTheListIsTurnedAway) {
  IgtlServerOptions options;
  options.allow = {"127.0.0.9"};
  start(options);
  tcp::socket socket(network_);
  socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
  socket.non_blocking(true);
  error_code error;
  EXPECT_TRUE(run_until([&] {
    std::array<char, 1> byte{};
    socket.read_some(asio::buffer(byte), error);
    return error == asio::error::eof;
  }));
  EXPECT_TRUE(opened_.empty());
}

TEST_F(IgtlServerTest, APortInUseIsNamedAndCanBeTakenOnceItIsFree) {
  std::uint16_t port = 0;
  {
    IgtlServer first(network_.get_executor());
    IgtlServerOptions options;
    options.port = 0;
    ASSERT_TRUE(first.listen(options).has_value());
    port = first.port();
    options.port = port;
    EXPECT_THAT(server_.listen(options).error(), HasSubstr(std::to_string(port)));
  }
  IgtlServerOptions again;
  again.port = port;
  EXPECT_TRUE(server_.listen(again).has_value()) << "after the first one is gone";
}

TEST_F(IgtlServerTest, AnswersInTheVersionThatThePeerHasShown) {
  start();
  auto socket = connect();
  FrameReader reader;
  server_.reply(opened_[0], "mode", Text{"one"});
  EXPECT_EQ(receive(socket, reader).version, 1);
  send(socket, write_frame(2, "STRING", "MODE", 0, test::text_body("manual")));
  ASSERT_TRUE(run_until([&] { return messages_.size() == 1; }));
  server_.reply(opened_[0], "mode", Text{"two"});
  const Message second = receive(socket, reader);
  EXPECT_EQ(second.version, 2);
  EXPECT_EQ(second.body, Body(Text{"two"}));
}

TEST_F(IgtlServerTest, ReadsWhatComesByteByByte) {
  start();
  auto socket = connect();
  socket.set_option(tcp::no_delay(true));
  for (const std::uint8_t byte : hello) {
    send(socket, {byte});
    network_.poll();
  }
  ASSERT_TRUE(run_until([&] { return messages_.size() == 1; }));
  EXPECT_EQ(messages_[0].body, Body(Text{"manual"}));
}

TEST_F(IgtlServerTest, AMessageThatDripsIsGivenUpAfterASecond) {
  start();
  auto socket = connect();
  const auto begun = time_;
  std::size_t sent = 0;
  asio::steady_timer drip(network_);
  const std::function<void()> drop = [&] {
    error_code ignored;
    socket.write_some(asio::buffer(&hello[sent], 1), ignored);
    sent = std::min(sent + 1, hello.size() - 1);
    drip.expires_after(50ms);
    drip.async_wait([&](const error_code& error) {
      if (!error) {
        drop();
      }
    });
  };
  drop();
  ASSERT_TRUE(is_closed_within(3s));
  drip.cancel();
  EXPECT_GE(time_ - begun, IgtlServer::message_timeout);
  EXPECT_THAT(closed_[0], HasSubstr("did not end in time"));
  EXPECT_TRUE(messages_.empty());
}

TEST_F(IgtlServerTest, SilenceBetweenMessagesIsNoFault) {
  start();
  auto socket = connect();
  send(socket, hello);
  EXPECT_FALSE(is_closed_within(IgtlServer::message_timeout + 200ms));
}

TEST_F(IgtlServerTest, APeerThatBreaksTheFramingIsClosedAndOthersStay) {
  start();
  auto broken = connect();
  auto other = connect();
  send(broken, test::header_of("VIDEO", 0xFFFFFFFFu, 0));
  ASSERT_TRUE(is_closed_within(3s));
  EXPECT_THAT(refused_, testing::ElementsAre(Fault::too_large));
  send(other, hello);
  EXPECT_TRUE(run_until([&] { return messages_.size() == 1; }));
}

TEST_F(IgtlServerTest, ThePeerThatBreaksTheFramingIsToldWhyThoughItSendsOn) {
  start();
  server_.on_refused = [this](PeerId peer, const Header& header, const FaultAt& fault) {
    server_.reply(peer, header.device, Status{status_of(fault), 0, "FORMAT", header.type});
  };
  auto socket = connect();
  using test::operator+;
  send(socket, test::header_of("VIDEO", 0xFFFFFFFFu, 0) + ByteVector(100'000, 0xA5));
  FrameReader reader;
  const Message told = receive(socket, reader);
  EXPECT_EQ(std::get<Status>(told.body).text, "VIDEO");
  EXPECT_TRUE(is_closed_within(3s));
}

TEST_F(IgtlServerTest, APeerThatBreaksTheFramingAndStaysIsClosedAfterTheAnswer) {
  start();
  auto socket = connect();
  send(socket, test::header_of("VIDEO", 0xFFFFFFFFu, 0));
  const auto begun = time_;
  ASSERT_TRUE(is_closed_within(3s));
  EXPECT_GE(time_ - begun, IgtlServer::parting_timeout);
  EXPECT_THAT(closed_[0], HasSubstr(std::string(fault_text(Fault::too_large))));
}

TEST_F(IgtlServerTest, ARefusedMessageShowsTheVersionOfItsPeerToo) {
  start();
  auto socket = connect();
  send(socket, write_frame(2, "VIDEO", "camera", 0, ByteVector(9)));
  ASSERT_TRUE(run_until([&] { return !refused_.empty(); }));
  server_.reply(opened_[0], "mode", Text{"one"});
  FrameReader reader;
  EXPECT_EQ(receive(socket, reader).version, 2);
}

TEST_F(IgtlServerTest, WhatIsRefusedIsCountedAndTheNextMessageRead) {
  start();
  auto socket = connect();
  using test::operator+;
  send(socket, test::header_of("STRING", 5, 1) + test::text_body("x") +
                   test::message_of("VIDEO", ByteVector(9)) + test::message_of("STRING", {0, 3, 0, 9}) +
                   hello);
  ASSERT_TRUE(run_until([&] { return messages_.size() == 1; }));
  EXPECT_THAT(refused_, testing::ElementsAre(Fault::checksum, Fault::unknown_type, Fault::inner_length));
  const Peer peer = server_.find(opened_[0]).value();
  EXPECT_EQ(peer.refused, 3u);
  EXPECT_EQ(peer.received, 1u);
  EXPECT_EQ(peer.heard.at("MODE").type, "STRING");
  EXPECT_THAT(peer.address, HasSubstr("127.0.0.1:"));
}

TEST_F(IgtlServerTest, OfAStreamTheNewestIsSentAndOfRepliesAll) {
  start();
  auto socket = connect();
  for (int i = 0; i < 50; ++i) {
    server_.show(opened_[0], "mode", Text{std::to_string(i)});
    server_.reply(opened_[0], "answer", Text{std::to_string(i)});
  }
  FrameReader reader;
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(receive(socket, reader).body, Body(Text{std::to_string(i)}));
  }
  const Message newest = receive(socket, reader);
  EXPECT_EQ(newest.device, "mode");
  EXPECT_EQ(newest.body, Body(Text{"49"}));
  EXPECT_EQ(server_.find(opened_[0])->replaced, 49u);
}

TEST_F(IgtlServerTest, APeerThatNeverReadsIsDroppedAndTakesNoMemoryMeanwhile) {
  start();
  auto socket = connect();
  const std::string long_text(60000, 'x');
  EXPECT_TRUE(run_until([&] {
    server_.show(opened_[0], "mode", Text{long_text});
    return !closed_.empty();
  }));
  EXPECT_THAT(closed_.at(0), HasSubstr("does not take"));
}

TEST_F(IgtlServerTest, APeerWhoseRepliesPileUpIsDropped) {
  start();
  auto socket = connect();
  for (std::size_t i = 0; i <= IgtlServer::backlog; ++i) {
    server_.reply(opened_[0], "answer", Text{"x"});
  }
  EXPECT_TRUE(is_closed_within(1s));
  EXPECT_THAT(closed_.at(0), HasSubstr("behind"));
}

TEST_F(IgtlServerTest, AControllerThatIsSilentIsLostWithin300MsAndAnObserverIsNot) {
  IgtlServerOptions options;
  options.controller_silence = 200ms;
  start(options);
  auto controller = connect();
  auto observer = connect();
  ASSERT_TRUE(server_.set_role(opened_[0], Role::controller));
  const auto begun = time_;
  ASSERT_TRUE(is_closed_within(2s));
  EXPECT_GE(time_ - begun, 200ms);
  EXPECT_LE(time_ - begun, 300ms);
  EXPECT_THAT(closed_.at(0), HasSubstr("silent"));
  EXPECT_TRUE(server_.find(opened_[1]).has_value());
}

TEST_F(IgtlServerTest, AControllerThatKeepsSendingStays) {
  IgtlServerOptions options;
  options.controller_silence = 200ms;
  start(options);
  auto socket = connect();
  server_.set_role(opened_[0], Role::controller);
  asio::steady_timer timer(network_);
  const std::function<void()> heartbeat = [&] {
    send(socket, write_frame(1, "GET_STATUS", "", 0, {}));
    timer.expires_after(60ms);
    timer.async_wait([&](const error_code& error) {
      if (!error) {
        heartbeat();
      }
    });
  };
  heartbeat();
  EXPECT_FALSE(is_closed_within(700ms));
  timer.cancel();
}

/** Sends something every 50 ms for as long as it lives. */
class Pulse {
 public:
  Pulse(tcp::socket& socket, asio::io_context& network) : socket_(socket), timer_(network) { heartbeat(); }

 private:
  void heartbeat() {
    asio::write(socket_, asio::buffer(message_));
    timer_.expires_after(50ms);
    timer_.async_wait([this](const error_code& error) {
      if (!error) {
        heartbeat();
      }
    });
  }

  const ByteVector message_ = write_frame(1, "GET_STATUS", "", 0, {});
  tcp::socket& socket_;
  asio::steady_timer timer_;
};

TEST_F(IgtlServerTest, AControllerThatHadSentRegularlyIsLostWithin300MsOfItsSilenceWhileSomethingMayMove) {
  bool moves = false;
  server_.is_in_motion = [&] { return moves; };
  start();
  auto controller = connect();
  server_.set_role(opened_[0], Role::controller);
  {
    const Pulse pulse(controller, network_);
    ASSERT_FALSE(is_closed_within(IgtlServer::heartbeat_proof + 300ms));
    moves = true;
    ASSERT_FALSE(is_closed_within(300ms)) << "it still sends";
  }
  const auto silent = time_;
  ASSERT_TRUE(is_closed_within(2s));
  EXPECT_GE(time_ - silent, 100ms);
  EXPECT_LE(time_ - silent, 300ms);
  EXPECT_THAT(closed_.at(0), HasSubstr("silent"));
}

TEST_F(IgtlServerTest, SilenceOfARegularControllerIsNoLossAtRestNorLaterWhenSomethingMoves) {
  bool moves = false;
  server_.is_in_motion = [&] { return moves; };
  start();
  auto controller = connect();
  server_.set_role(opened_[0], Role::controller);
  {
    const Pulse pulse(controller, network_);
    ASSERT_FALSE(is_closed_within(IgtlServer::heartbeat_proof + 300ms));
  }
  EXPECT_FALSE(is_closed_within(400ms)) << "nothing may move";
  moves = true;
  EXPECT_FALSE(is_closed_within(400ms)) << "it was silent before";
}

TEST_F(IgtlServerTest, AControllerThatSendsNowAndThenIsNotLostBySilence) {
  server_.is_in_motion = [] { return true; };
  start();
  auto controller = connect();
  server_.set_role(opened_[0], Role::controller);
  for (int burst = 0; burst < 3; ++burst) {
    const Pulse pulse(controller, network_);
    ASSERT_FALSE(is_closed_within(200ms));
  }
  EXPECT_FALSE(is_closed_within(500ms));
}

TEST_F(IgtlServerTest, APeerThatClosesWithinAMessageIsGoneAtOnceWhateverWasToCome) {
  start();
  const ByteVector skipped = test::header_of("VIDEO", 60000, 0);
  const ByteVector known = test::header_of("POINT", 136, 0);
  std::vector<ByteVector> beginnings{skipped, known, ByteVector(hello.begin(), hello.begin() + 20)};
  beginnings[0].resize(skipped.size() + 100);
  beginnings[1].resize(known.size() + 100);
  for (std::size_t i = 0; i < beginnings.size(); ++i) {
    auto socket = connect();
    send(socket, beginnings[i]);
    socket.close();
    const auto begun = time_;
    ASSERT_TRUE(run_until([&] { return closed_.size() == i + 1; })) << i;
    EXPECT_LE(time_ - begun, 500ms) << i;
  }
  EXPECT_TRUE(server_.empty());
  EXPECT_LE(network_.run_for(200ms), 40u) << "nothing goes round for the rest of a message";
  auto next = connect();
  send(next, hello);
  EXPECT_TRUE(run_until([&] { return messages_.size() == 1; }));
}

TEST_F(IgtlServerTest, AProgramThatListensIsNotConnectedToBeyondTheCapacity) {
  start();
  tcp::acceptor listening(network_, {asio::ip::make_address("127.0.0.1"), 0});
  std::vector<tcp::socket> peers;
  for (std::size_t i = 0; i < IgtlServer::capacity; ++i) {
    peers.push_back(connect());
  }
  asio::co_spawn(network_, server_.keep_connected(listening.local_endpoint(), 20ms), asio::detached);
  EXPECT_FALSE(run_until([&] { return server_.peers().size() > IgtlServer::capacity; }, 200ms));
  peers.pop_back();
  EXPECT_TRUE(run_until([&] { return opened_.size() == IgtlServer::capacity + 1; })) << "a place is free";
  EXPECT_EQ(server_.peers().size(), IgtlServer::capacity);
}

TEST_F(IgtlServerTest, ItsEndIsNoticedAtOnce) {
  start();
  auto socket = connect();
  socket.close();
  const auto begun = time_;
  ASSERT_TRUE(is_closed_within(1s));
  EXPECT_LE(time_ - begun, 100ms);
  EXPECT_TRUE(server_.empty());
}

TEST_F(IgtlServerTest, NoMoreThanItsCapacityAreServedAndAPlaceIsFreeAgain) {
  start();
  std::vector<tcp::socket> peers;
  for (std::size_t i = 0; i < IgtlServer::capacity; ++i) {
    peers.push_back(connect());
  }
  tcp::socket one_more(network_);
  one_more.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
  one_more.non_blocking(true);
  error_code error;
  EXPECT_TRUE(run_until([&] {
    std::array<char, 1> byte{};
    one_more.read_some(asio::buffer(byte), error);
    return error == asio::error::eof;
  }));
  EXPECT_EQ(server_.peers().size(), IgtlServer::capacity);
  ASSERT_TRUE(server_.disconnect(opened_[3], "for a test"));
  ASSERT_TRUE(is_closed_within(1s));
  EXPECT_FALSE(server_.disconnect(opened_[3], "again"));
  connect();
}

TEST_F(IgtlServerTest, TwoHundredConnectionsLeaveNoDescriptor) {
  start();
  connect().close();
  ASSERT_TRUE(run_until([&] { return closed_.size() == 1; }));
  const std::size_t before = open_descriptors();
  for (std::size_t i = 0; i < 200; ++i) {
    auto socket = connect();
    send(socket, hello);
    socket.close();
    ASSERT_TRUE(run_until([&] { return closed_.size() == i + 2; }));
  }
  EXPECT_EQ(messages_.size(), 200u);
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(IgtlServerTest, WhoSendsTooMuchIsReadLater) {
  start();
  const auto begun = steady_clock::now();
  auto socket = connect();
  ByteVector flood;
  for (std::size_t i = 0; i < 2 * IgtlServer::most_messages + 1; ++i) {
    flood.insert(flood.end(), hello.begin(), hello.end());
  }
  send(socket, flood);
  ASSERT_TRUE(run_until([&] { return messages_.size() == 2 * IgtlServer::most_messages + 1; }));
  EXPECT_GE(steady_clock::now() - begun, IgtlServer::rate_window);
}

TEST_F(IgtlServerTest, AStopIsSeenThoughItWaitsBehindWhatIsReadLater) {
  std::optional<std::size_t> read_before;
  server_.on_stop_ahead = [&] { read_before = read_before.value_or(messages_.size()); };
  start();
  auto socket = connect();
  ByteVector flood;
  for (std::size_t i = 0; i < IgtlServer::most_messages + 20; ++i) {
    flood.insert(flood.end(), hello.begin(), hello.end());
  }
  const ByteVector stop = write_frame(1, "STATUS", "STOP", 0, encode(Status{}));
  flood.insert(flood.end(), stop.begin(), stop.end());
  send(socket, flood);
  ASSERT_TRUE(run_until([&] { return messages_.size() == IgtlServer::most_messages + 21; }));
  ASSERT_TRUE(read_before);
  EXPECT_LE(*read_before, IgtlServer::most_messages + 1);
}

/** The library's own sockets block, so the server runs in a thread of its own meanwhile. */
class IgtlServerAndLibraryTest : public IgtlServerTest {
 protected:
  void run_beside() {
    server_.read_clock = steady_clock::now;
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        network_.run_one_for(5ms);
      }
    });
  }

  std::jthread thread_;
};

template <typename Pointer>
void send_packed(::igtl::Socket& socket, const Pointer& message) {
  message->Pack();
  ASSERT_EQ(socket.Send(message->GetPackPointer(), message->GetPackSize()), 1);
}

/** As the library's examples receive: header, then body. */
template <typename LibraryMessage>
typename LibraryMessage::Pointer receive_with_library(::igtl::Socket& socket) {
  const auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  EXPECT_EQ(socket.Receive(header->GetPackPointer(), header->GetPackSize()), header->GetPackSize());
  header->Unpack();
  typename LibraryMessage::Pointer message = LibraryMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  socket.Receive(message->GetPackBodyPointer(), message->GetPackBodySize());
  EXPECT_NE(message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY, 0);
  return message;
}

TEST_F(IgtlServerAndLibraryTest, APeerOnDebiansLibraryIsUnderstoodAndUnderstands) {
  start();
  server_.on_message = [this](PeerId id, const Message& message) {
    server_.reply(id, "ECHO_" + message.device, message.body);
  };
  run_beside();
  const auto client = ::igtl::ClientSocket::New();
  ASSERT_EQ(client->ConnectToServer("127.0.0.1", server_.port()), 0);
  const auto sent = ::igtl::TransformMessage::New();
  sent->SetDeviceName("REGISTRATION");
  ::igtl::Matrix4x4 matrix{{0, -1, 0, 1.5f}, {1, 0, 0, -2.25f}, {0, 0, 1, 3}, {0, 0, 0, 1}};
  sent->SetMatrix(matrix);
  send_packed(*client, sent);
  const auto echo = receive_with_library<::igtl::TransformMessage>(*client);
  EXPECT_STREQ(echo->GetDeviceName(), "ECHO_REGISTRATION");
  ::igtl::Matrix4x4 read;
  echo->GetMatrix(read);
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(read[i / 4][i % 4], matrix[i / 4][i % 4]);
  }
  const auto status = ::igtl::StatusMessage::New();
  status->SetDeviceName("S");
  status->SetCode(13);
  status->SetErrorName("NAME");
  status->SetStatusString("text");
  send_packed(*client, status);
  const auto status_echo = receive_with_library<::igtl::StatusMessage>(*client);
  EXPECT_EQ(status_echo->GetCode(), 13);
  EXPECT_STREQ(status_echo->GetStatusString(), "text");
  client->CloseSocket();
}

TEST_F(IgtlServerAndLibraryTest, ConnectsToAPeerThatListens) {
  const auto server = ::igtl::ServerSocket::New();
  ASSERT_EQ(server->CreateServer(0), 0);
  const auto port = static_cast<std::uint16_t>(server->GetServerPort());
  server_.on_open = [this](PeerId id) { server_.reply(id, "mode", Text{"manual"}); };
  asio::co_spawn(network_, server_.keep_connected({asio::ip::make_address("127.0.0.1"), port}, 20ms),
                 asio::detached);
  run_beside();
  for (int visit = 0; visit < 2; ++visit) {  // the second after the first was closed
    const auto peer = server->WaitForConnection(3000);
    ASSERT_TRUE(peer.IsNotNull());
    EXPECT_STREQ(receive_with_library<::igtl::StringMessage>(*peer)->GetString(), "manual");
    peer->CloseSocket();
  }
}

}  // namespace
}  // namespace interlock::igtl
