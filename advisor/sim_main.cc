// terra-llm-sim: a local server that plays a language model, for people without
// a key and for tests of the whole way. It speaks the four providers' forms on
// 127.0.0.1 and answers from the question's own text and picture.
// Listens to no bus; exits when asked to (SIGINT, SIGTERM).
#include <httplib.h>
#include <signal.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "advisor/sim_answer.h"
#include "advisor/sim_wire.h"
#include "bus/number_range.h"
#include "output/output_file.h"
#include "output/standard_output.h"

namespace {

constexpr const char* kModel = "terra-llm-sim";
constexpr std::size_t kMaxRequestBytes = 32u << 20;
constexpr const char* kJson = "application/json";

void Reply(const httplib::Request& request, httplib::Response& response,
           double latency_s) {
  using namespace terra::advisor;  // NOLINT(google-build-using-namespace)
  const auto question = ReadWireQuestion(request.path, request.body);
  if (!question || question->pngs.empty()) {
    response.status = 400;
    response.set_content(
        R"({"error":{"type":"invalid_request_error","message":)"
        R"("a question of four known forms, with a picture, please"}})",
        kJson);
    return;
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(latency_s));
  const std::string answer =
      SimulatedAnswer(question->text, question->pngs.front());
  std::cerr << question->provider << ": " << answer << std::endl;
  response.set_content(WriteWireReply(question->provider, kModel, answer),
                       kJson);
}

int Serve(int port, const std::string& port_file, double latency_s) {
  // Blocked in every thread: sigwait below takes them.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  httplib::Server server;
  server.set_payload_max_length(kMaxRequestBytes);
  server.set_keep_alive_timeout(1);  // An idle connection delays the end.
  server.Post(".*", [latency_s](const httplib::Request& request,
                                httplib::Response& response) {
    Reply(request, response, latency_s);
  });
  const char* host = "127.0.0.1";
  const int bound = port != 0 ? (server.bind_to_port(host, port) ? port : -1)
                              : server.bind_to_any_port(host);
  if (bound < 0) {
    std::cerr << "terra-llm-sim: cannot listen on port " << port << "\n";
    return 1;
  }
  if (!port_file.empty()) {
    // The port is open already: who connects now waits for the thread below.
    const auto written =
        terra::WriteWholeFile(port_file, std::to_string(bound) + "\n");
    if (!written) {
      std::cerr << "terra-llm-sim: " << written.error().message << "\n";
      return 1;
    }
  }
  std::cout << "http://" << host << ":" << bound << "\n";
  const auto said = terra::FlushStandardOutput();
  if (!said) {  // Nobody would know where it listens.
    std::cerr << "terra-llm-sim: " << said.error().message << "\n";
    return 1;
  }
  std::thread serving([&server] {
    server.listen_after_bind();
  });
  int signal = 0;
  sigwait(&signals, &signal);
  server.stop();
  serving.join();
  return 0;
}

int Run(int argc, char** argv) {
  CLI::App app{
      "A local server that plays a language model: it answers questions about "
      "terrain maps from their own text and picture. Its answers say nothing "
      "about any real model.\nexample: terra-llm-sim --port 8080",
      "terra-llm-sim"};
  int port = 0;
  std::string port_file;
  double latency_s = 1;
  app.add_option("--port", port, "Port on 127.0.0.1; 0 = any free one")
      ->capture_default_str()
      ->check(CLI::Range(0, 65'535));
  app.add_option("--port-file", port_file, "Write the port here when ready");
  app.add_option("--latency", latency_s, "Seconds that an answer takes")
      ->capture_default_str()
      ->check(terra::bus::InRange(0.0, 600.0));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return Serve(port, port_file, latency_s);
}

}  // namespace

int main(int argc, char** argv) {
  terra::ReserveStandardStreams();
  return terra::FinishStandardOutput("terra-llm-sim", Run(argc, argv));
}
