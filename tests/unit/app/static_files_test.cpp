#include "http/static_files.hpp"

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <exception>
#include <fstream>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "temporary_folder.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

asio::awaitable<Response> answer_of(StaticFiles& files, const Request& request,
                                    const std::function<void()>& between) {
  AnyResponse answer = co_await files.serve(request);
  if (auto* plain = std::get_if<Response>(&answer)) {
    co_return std::move(*plain);
  }
  auto& [head, body] = std::get<FileResponse>(answer);
  while (body && head.body().size() < body->size()) {
    const auto piece = co_await body->piece(head.body().size());
    if (!piece) {
      head.set("Ended", "early");
      break;
    }
    EXPECT_TRUE(!piece->empty() && piece->size() <= FileBody::longest_piece);
    head.body() += *piece;
    between();
  }
  co_return std::move(head);
}

/** The answer with its whole body; `between` is called after each piece. */
Response serve(StaticFiles& files, const Request& request, const std::function<void()>& between = [] {}) {
  asio::io_context context;
  Response answered;
  asio::co_spawn(context, answer_of(files, request, between),
                 [&](const std::exception_ptr& thrown, Response response) {
                   EXPECT_FALSE(thrown);
                   answered = std::move(response);
                 });
  context.run();
  return answered;
}

class StaticFilesTest : public testing::Test {
 protected:
  StaticFilesTest() {
    std::filesystem::create_directories(root() / "assets");
    write(root() / "index.html", "<title>console</title>");
    write(root() / "assets" / "app.js", "1");
    write(root() / "assets" / "core.wasm", "2");
    write(root() / "a b.txt", "3");
    write(folder_.path() / "secret", "never");
    std::filesystem::create_directories(documents() / "code");
    write(documents() / "index.html", "<title>documents</title>");
    write(documents() / "code" / "a.html", "4");
    std::filesystem::create_symlink(folder_.path() / "secret", root() / "link");
    std::filesystem::create_symlink(folder_.path() / "secret", root() / "index.html.br");
    std::filesystem::create_symlink(folder_.path() / "secret", documents() / "link");
    write(root() / "assets" / "index-Dc8Mo0lP.js", "as it is");
    write(root() / "assets" / "index-Dc8Mo0lP.js.br", "brotli");
    write(root() / "assets" / "index-Dc8Mo0lP.js.gz", "gzip");
    write(root() / "archive.gz", "5");
  }

  [[nodiscard]] std::filesystem::path root() const { return folder_.path() / "web"; }
  [[nodiscard]] std::filesystem::path documents() const { return folder_.path() / "site"; }

  static void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }

  [[nodiscard]] Response get(const std::string& target, http::verb method = http::verb::get) const {
    return ask(Request{method, target, 11});
  }

  [[nodiscard]] Response ask(const Request& request) const {
    StaticFiles files(root(), documents());
    return serve(files, request);
  }

  [[nodiscard]] Response ask(const std::string& target, http::field name, const std::string& value) const {
    Request request{http::verb::get, target, 11};
    request.set(name, value);
    return ask(request);
  }

  static constexpr const char* script = "/assets/index-Dc8Mo0lP.js";

  test::TemporaryFolder folder_;
};

TEST_F(StaticFilesTest, ServesTheIndexAtTheRoot) {
  const Response response = get("/");
  EXPECT_EQ(response.result(), boost::beast::http::status::ok);
  EXPECT_EQ(response.body(), "<title>console</title>");
  EXPECT_EQ(response[http::field::content_type], "text/html; charset=utf-8");
}

TEST_F(StaticFilesTest, NamesTheTypeOfEachFile) {
  EXPECT_EQ(get("/assets/app.js?v=1")[http::field::content_type], "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/assets/core.wasm")[http::field::content_type], "application/wasm");
}

TEST_F(StaticFilesTest, DecodesPaths) { EXPECT_EQ(get("/a%20b.txt").body(), "3"); }

TEST_F(StaticFilesTest, NeverLeavesItsFolder) {
  for (const std::string target :
       {"/../secret", "/assets/../../secret", "/%2e%2e/secret", "/..%2fsecret", "//../secret", "/link",
        "/index.html%00.txt", "/%zz", "/%2", "relative", "/assets", "/assets/", "/docs/../secret",
        "/docs/%2e%2e/web/index.html", "/docs/code/", "/docsindex.html", "/docs/link"}) {
    EXPECT_EQ(get(target).result(), boost::beast::http::status::not_found) << target;
  }
}

TEST_F(StaticFilesTest, ServesTheDocumentsBelowTheirOwnPath) {
  EXPECT_EQ(get("/docs/").body(), "<title>documents</title>");
  EXPECT_EQ(get("/docs/code/a.html").body(), "4");
  EXPECT_EQ(get("/docs/assets/app.js").result(), boost::beast::http::status::not_found);
  EXPECT_EQ(get("/code/a.html").result(), boost::beast::http::status::not_found);
  const Response moved = get("/docs");
  EXPECT_EQ(moved.result(), boost::beast::http::status::permanent_redirect);
  EXPECT_EQ(moved[http::field::location], "/docs/");
}

TEST_F(StaticFilesTest, SaysHowToBringTheDocuments) {
  for (const std::string target : {"/docs", "/docs/", "/docs/index.html"}) {
    StaticFiles files(root());
    const Response response = serve(files, Request{http::verb::get, target, 11});
    EXPECT_EQ(response.result(), boost::beast::http::status::not_found) << target;
    EXPECT_NE(response.body().find("make docs"), std::string::npos) << target;
  }
}

TEST_F(StaticFilesTest, OnlyReads) {
  for (const std::string target : {"/index.html", "/docs/index.html"}) {
    const Response response = get(target, http::verb::post);
    EXPECT_EQ(response.result(), boost::beast::http::status::method_not_allowed) << target;
    EXPECT_EQ(response[http::field::allow], "GET, HEAD") << target;
  }
}

TEST_F(StaticFilesTest, SaysHowToBringTheConsole) {
  StaticFiles files({});
  const Response response = serve(files, Request{http::verb::get, "/", 11});
  EXPECT_EQ(response.result(), boost::beast::http::status::not_found);
  EXPECT_NE(response.body().find("--web"), std::string::npos);
}

TEST_F(StaticFilesTest, SendsTheFormThatTheClientLikesBest) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"br, gzip", "brotli"},
      {"gzip, deflate, br", "brotli"},
      {"gzip", "gzip"},
      {"GZIP", "gzip"},
      {"x-gzip", "gzip"},
      {"gzip;q=0.001", "gzip"},
      {"br;q=0.5, gzip;q=0.8", "gzip"},
      {"br;q=0.5,gzip;Q=0.501", "gzip"},
      {"br;q=0, gzip", "gzip"},
      {"br;q=0.000", "as it is"},
      {"br; q=0 , gzip ; q=0", "as it is"},
      {"br;q=0.5, identity", "as it is"},
      {"br;q=0.5, identity;q=0.4", "brotli"},
      {"*", "brotli"},
      {"*;q=0.5, br;q=0", "gzip"},
      {"br;q=0, *;q=0", "as it is"},
      {"identity;q=0", "as it is"},
      {"gzip;q=2", "as it is"},
      {"gzip;q=1.001", "as it is"},
      {"gzip;q=0.0001", "as it is"},
      {"gzip;q=x", "as it is"},
      {"gzip;q=-1", "as it is"},
      {"brotli, deflate, zstd", "as it is"},
      {", ,br", "brotli"},
      {"", "as it is"},
      {"\"", "as it is"},
  };
  for (const auto& [accepted, body] : cases) {
    const Response response = ask(script, http::field::accept_encoding, accepted);
    EXPECT_EQ(response.body(), body) << accepted;
    EXPECT_EQ(response[http::field::content_encoding], body == "brotli" ? "br"
                                                       : body == "gzip" ? "gzip"
                                                                        : "")
        << accepted;
    EXPECT_EQ(response[http::field::vary], "Accept-Encoding") << accepted;
    EXPECT_EQ(response[http::field::content_type], "text/javascript; charset=utf-8") << accepted;
  }
  EXPECT_EQ(get(script).body(), "as it is");
  Request lines{http::verb::get, script, 11};
  lines.insert(http::field::accept_encoding, "br;q=0.1");
  lines.insert(http::field::accept_encoding, "gzip");
  EXPECT_EQ(ask(lines).body(), "gzip");
}

TEST_F(StaticFilesTest, SendsAsItIsWhatIsNotCompressed) {
  const Response response = ask("/assets/app.js", http::field::accept_encoding, "br, gzip");
  EXPECT_EQ(response.body(), "1");
  EXPECT_EQ(response.count(http::field::content_encoding), 0u);
  EXPECT_EQ(response.count(http::field::vary), 0u);
}

TEST_F(StaticFilesTest, ServesNoCompressedFormUnderItsOwnName) {
  EXPECT_EQ(get(std::string(script) + ".br").result(), boost::beast::http::status::not_found);
  EXPECT_EQ(get(std::string(script) + ".gz").result(), boost::beast::http::status::not_found);
  EXPECT_EQ(get("/archive.gz").body(), "5");
}

TEST_F(StaticFilesTest, TakesNoCompressedFormFromOutside) {
  EXPECT_EQ(ask("/", http::field::accept_encoding, "br").body(), "<title>console</title>");
  EXPECT_EQ(get("/index.html.br").result(), boost::beast::http::status::not_found);
}

TEST_F(StaticFilesTest, GivesEachFormATagOfItsOwn) {
  const std::string plain(get(script)[http::field::etag]);
  EXPECT_TRUE(plain.size() == 34 && plain.starts_with('"') && plain.ends_with('"')) << plain;
  const std::string brotli(ask(script, http::field::accept_encoding, "br")[http::field::etag]);
  const std::string gzip(ask(script, http::field::accept_encoding, "gzip")[http::field::etag]);
  EXPECT_EQ((std::set{plain, brotli, gzip}).size(), 3u);
  EXPECT_EQ(plain, get(script)[http::field::etag]);
  write(root() / "assets" / "index-Dc8Mo0lP.js", "As it is");
  EXPECT_NE(plain, get(script)[http::field::etag]);
}

TEST_F(StaticFilesTest, SendsNothingThatTheClientHasAlready) {
  for (const std::string target : {script, "/", "/docs/"}) {
    const Response whole = get(target);
    const std::string tag(whole[http::field::etag]);
    const std::string strong = tag.substr(tag.find('"'));
    for (const std::string& known :
         {tag, strong, "W/" + strong, "\"other\", " + tag, "\"a,b\"," + tag + ",W/\"c\"", std::string("*")}) {
      const Response response = ask(target, http::field::if_none_match, known);
      EXPECT_EQ(response.result(), boost::beast::http::status::not_modified) << target << ' ' << known;
      EXPECT_EQ(response.body(), "");
      EXPECT_EQ(response[http::field::etag], tag);
      EXPECT_EQ(response[http::field::cache_control], whole[http::field::cache_control]);
      EXPECT_EQ(response[http::field::vary], whole[http::field::vary]);
    }
    for (const std::string& other :
         {std::string("\"other\""), strong.substr(1), strong.substr(0, strong.size() - 1), std::string()}) {
      const Response response = ask(target, http::field::if_none_match, other);
      EXPECT_EQ(response.result(), boost::beast::http::status::ok) << target << ' ' << other;
      EXPECT_EQ(response.body(), whole.body());
    }
  }
  EXPECT_EQ(ask("/nothing", http::field::if_none_match, "*").result(), boost::beast::http::status::not_found);
  Request other_form{http::verb::get, script, 11};
  other_form.set(http::field::accept_encoding, "br");
  other_form.set(http::field::if_none_match, get(script)[http::field::etag]);
  EXPECT_EQ(ask(other_form).body(), "brotli");
}

TEST_F(StaticFilesTest, LetsBrowsersKeepForEverOnlyWhatIsNamedByItsContent) {
  EXPECT_EQ(get(script)[http::field::cache_control], "public, max-age=31536000, immutable");
  for (const std::string target : {"/", "/index.html", "/assets/app.js", "/archive.gz", "/docs/"}) {
    EXPECT_EQ(get(target)[http::field::cache_control], "no-cache") << target;
  }
}

TEST_F(StaticFilesTest, SendsLargeFilesInPieces) {
  std::string large;
  while (large.size() < 3 * FileBody::longest_piece) {
    large += std::to_string(large.size());
  }
  write(root() / "large.bin", large);
  write(documents() / "large.bin", large);
  write(root() / "empty", "");
  write(documents() / "empty", "");
  EXPECT_EQ(get("/large.bin").body(), large);
  EXPECT_EQ(get("/docs/large.bin").body(), large);
  EXPECT_EQ(get("/empty").result(), boost::beast::http::status::ok);
  EXPECT_EQ(get("/docs/empty").result(), boost::beast::http::status::ok);
}

TEST_F(StaticFilesTest, KeepsTheConsoleAsItWasAtTheStart) {
  StaticFiles files(root(), documents());
  std::filesystem::remove_all(root());
  EXPECT_EQ(serve(files, Request{http::verb::get, "/", 11}).body(), "<title>console</title>");
}

TEST_F(StaticFilesTest, DoesNotMixTwoEditionsOfADocument) {
  const std::string former(3 * FileBody::longest_piece, 'a');
  write(documents() / "large.bin", former);
  StaticFiles files(root(), documents());
  const Response response = serve(files, Request{http::verb::get, "/docs/large.bin", 11},
                                  [&] { write(documents() / "large.bin", former + "b"); });
  EXPECT_EQ(response["Ended"], "early");
  EXPECT_EQ(response.body().size(), FileBody::longest_piece);
}

TEST_F(StaticFilesTest, KeepsNoMoreInMemoryThanAConsoleNeeds) {
  const std::string half(StaticFiles::most_bytes / 2, 'a');
  write(root() / "one", half);
  write(root() / "two", half);
  const bool one = get("/one").result() == boost::beast::http::status::ok;
  const bool two = get("/two").result() == boost::beast::http::status::ok;
  EXPECT_NE(one, two);
}

}  // namespace
}  // namespace interlock::web
