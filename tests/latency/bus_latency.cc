// Measures the deployed path over LCM with real processes: request to baseline,
// baseline to deployed, advice to verdict, request to refined route, in peace
// and under every kind of trouble that an advisor can make. Prints a table.
//
// usage: bus_latency [--requests N] [--rate HZ] [--map FILE --start X,Y
//        --goal X,Y] [--csv FILE]
#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include <CLI/CLI.hpp>

#include "bus/bus.h"
#include "bus/envelope.h"
#include "bus/inbox.h"
#include "terrain/cell.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_bus.h"

namespace terra {
namespace {

using std::chrono::milliseconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;
using testing::ChildProcess;
using testing::ProgramPath;

struct Arguments {
  int requests = 1500;  // So that p99.9 is not the maximum.
  double rate_hz = 50;
  std::string map = TERRA_EXAMPLE_MAP;
  std::string start = "30,250";
  std::string goal = "470,250";
  std::string csv;
};

// Times of one request in microseconds since 1970; 0 = it never came.
struct Times {
  std::int64_t asked = 0;
  std::int64_t planned = 0;   // The planner's stamp, just before it publishes.
  std::int64_t baseline = 0;  // Receipts, on this side.
  std::int64_t deployed = 0;
  std::int64_t advised = 0;
  std::int64_t verdict = 0;
  std::int64_t refined = 0;
};

// Asks at a fixed rate and notes when each answer is received.
class Requester {
 public:
  Requester(const testing::TestBus& buses, Cell start, Cell goal)
      : deployed_bus_(Open(buses.url())),
        advice_bus_(Open(buses.advice_url())),
        out_(*deployed_bus_, bus::RandomId()),
        start_(start),
        goal_(goal) {
    const bus::Channel heard[] = {bus::Channel::kBaseline,
                                  bus::Channel::kDeployed,
                                  bus::Channel::kVerdict};
    const bus::Channel advice[] = {bus::Channel::kAdvice};
    Require(deployed_bus_->Listen(heard, inbox_));
    Require(advice_bus_->Listen(advice, advice_inbox_));
  }

  std::vector<Times> Run(int requests, double rate_hz) {
    times_.clear();
    order_.clear();
    const auto period = std::chrono::duration_cast<bus::Duration>(
        std::chrono::duration<double>(1 / rate_hz));
    bus::Time next = bus::Clock::now();
    for (int i = 0; i < requests; ++i) {
      Ask();
      next += period;
      ReceiveUntil(next);
    }
    ReceiveUntil(bus::Clock::now() + milliseconds(500));
    std::vector<Times> all;
    for (const std::int64_t id : order_) all.push_back(times_.at(id));
    return all;
  }

  // Asks until something is deployed: the set is up.
  bool WaitUntilUp() {
    for (int i = 0; i < 300; ++i) {
      Ask();
      ReceiveUntil(bus::Clock::now() + milliseconds(100));
      if (times_.at(order_.back()).deployed != 0) return true;
    }
    return false;
  }

 private:
  static void Require(const Status& status) {
    if (!status) throw std::runtime_error(status.error().message);
  }
  static std::unique_ptr<bus::Bus> Open(const std::string& url) {
    auto opened =
        bus::Bus::Open(url, bus::ChannelNames::Create("", "").value());
    if (!opened) throw std::runtime_error(opened.error().message);
    return *std::move(opened);
  }

  void Ask() {
    terra_msg::plan_request_t request{};
    request.request_id = bus::RandomId();
    request.action = terra_msg::plan_request_t::ACTION_GO;
    request.start_x = start_.x;
    request.start_y = start_.y;
    request.goal_x = goal_.x;
    request.goal_y = goal_.y;
    order_.push_back(request.request_id);
    times_[request.request_id].asked = bus::UnixMicroseconds();
    out_.Send(request);
  }

  void ReceiveUntil(bus::Time until) {
    while (true) {
      Drain(inbox_);
      Drain(advice_inbox_);
      const auto left =
          std::chrono::ceil<milliseconds>(until - bus::Clock::now());
      if (left.count() <= 0) return;
      pollfd readable[] = {{inbox_.fd(), POLLIN, 0},
                           {advice_inbox_.fd(), POLLIN, 0}};
      ::poll(readable, 2, static_cast<int>(left.count()));
    }
  }

  void Drain(bus::Inbox& inbox) {
    inbox.Clear();
    while (const auto raw = inbox.Pop()) Note(*raw);
  }

  void Note(const bus::RawMessage& raw) {
    const std::int64_t now = bus::UnixMicroseconds();
    auto first = [now](std::int64_t& time) {
      if (time == 0) time = now;
    };
    if (const auto message = As<baseline_t>(raw)) {
      if (Times* times = Find(message->request_id)) {
        if (times->planned == 0) times->planned = message->utime;
        first(times->baseline);
      }
    } else if (const auto deployed = As<deployed_t>(raw)) {
      Times* times = Find(deployed->request_id);
      if (times && deployed->mode == deployed_t::MODE_BASELINE) {
        first(times->deployed);
      } else if (times && deployed->mode == deployed_t::MODE_CANDIDATE) {
        first(times->refined);
      }
    } else if (const auto verdict = As<verdict_t>(raw)) {
      if (Times* times = Find(verdict->request_id)) first(times->verdict);
    } else if (const auto advice = As<advice_t>(raw)) {
      Times* times = Find(advice->request_id);
      if (times && times->advised == 0) times->advised = advice->utime;
    }
  }

  template <typename T>
  static std::optional<T> As(const bus::RawMessage& raw) {
    if (raw.channel != bus::MessageTraits<T>::kChannel) return std::nullopt;
    const Result<T> message = bus::Decode<T>(raw.bytes);
    if (!message.ok()) return std::nullopt;
    return *message;
  }

  Times* Find(std::int64_t request_id) {
    const auto found = times_.find(request_id);
    return found == times_.end() ? nullptr : &found->second;
  }

  bus::Inbox inbox_;
  bus::Inbox advice_inbox_;
  std::unique_ptr<bus::Bus> deployed_bus_;
  std::unique_ptr<bus::Bus> advice_bus_;
  bus::Outbox out_;
  Cell start_;
  Cell goal_;
  std::unordered_map<std::int64_t, Times> times_;
  std::vector<std::int64_t> order_;
};

// Something that goes on in a thread while requests are made.
class Trouble {
 public:
  explicit Trouble(const std::function<void(const std::atomic<bool>&)>& make)
      : thread_([this, make] {
          make(stop_);
        }) {}
  ~Trouble() {
    stop_ = true;
    thread_.join();
  }
  Trouble(const Trouble&) = delete;
  Trouble& operator=(const Trouble&) = delete;

 private:
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class Bench {
 public:
  Bench(const Arguments& arguments, Cell start, Cell goal)
      : arguments_(arguments), requester_(buses_, start, goal) {
    std::printf("%-34s %-22s %5s %5s %8s %8s %8s %8s %8s\n", "advisor", "stage",
                "n", "lost", "p50", "p95", "p99", "p99.9", "max ms");
    if (!arguments.csv.empty()) {
      csv_.open(arguments.csv);
      csv_ << "scenario,stage,n,lost,p50_ms,p95_ms,p99_ms,p999_ms,max_ms\n";
    }
    Start("map", {"--map", arguments.map});
    Start("planner", {});
    Start("verifier", {});
    Start("logger", {"--out", folder_.Path("log")});
    if (!requester_.WaitUntilUp()) {
      throw std::runtime_error("the set did not come up");
    }
  }

  void RunAll() {
    Measure("none");
    {
      ChildProcess advisor(Advisor());
      Measure("search");
      advisor.Signal(SIGSTOP);
      Measure("stopped (SIGSTOP)");
    }
    {
      const Trouble kills([this](const std::atomic<bool>& stop) {
        while (!stop) {
          ChildProcess advisor(Advisor());
          advisor.WaitForExit(milliseconds(150));  // Killed at its end.
        }
      });
      Measure("killed (SIGKILL) 7 times a second");
    }
    {
      const Trouble flood([this](const std::atomic<bool>& stop) {
        testing::BusPeer babbler(buses_.advice_url());
        advice_t advice{};
        advice.advisor = "babbler";
        while (!stop) babbler.Send(advice);
      });
      Measure("flooding the advice bus");
    }
    {
      ChildProcess advisor(Advisor());
      const Trouble first(Burn);
      const Trouble second(Burn);
      Measure("search, two busy cores");
    }
  }

 private:
  static void Burn(const std::atomic<bool>& stop) {
    while (!stop) {
    }
  }

  std::vector<std::string> Command(const std::string& name) const {
    return {ProgramPath("terra-" + name), "--lcm-url", buses_.url(),
            "--advice-url", buses_.advice_url()};
  }
  std::vector<std::string> Advisor() const { return Command("advisor"); }
  void Start(const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> command = Command(name);
    command.insert(command.end(), options.begin(), options.end());
    processes_.push_back(std::make_unique<ChildProcess>(command));
  }

  void Measure(const std::string& scenario) {
    const std::vector<Times> times =
        requester_.Run(arguments_.requests, arguments_.rate_hz);
    Print(scenario, "request to baseline", times, &Times::asked,
          &Times::baseline);
    Print(scenario, "baseline to deployed", times, &Times::planned,
          &Times::deployed);
    Print(scenario, "advice to verdict", times, &Times::advised,
          &Times::verdict);
    Print(scenario, "request to refined", times, &Times::asked,
          &Times::refined);
  }

  void Print(const std::string& scenario, const char* stage,
             const std::vector<Times>& times, std::int64_t Times::*from,
             std::int64_t Times::*to) {
    std::vector<double> ms;
    int lost = 0;
    for (const Times& one : times) {
      if (one.*from == 0) continue;
      if (one.*to == 0) {
        ++lost;
      } else {
        ms.push_back(static_cast<double>(one.*to - one.*from) / 1000);
      }
    }
    // Without an advisor nothing is advised and nothing refined.
    if (ms.empty() && to != &Times::deployed) return;
    std::sort(ms.begin(), ms.end());
    auto percentile = [&ms](double p) {
      if (ms.empty()) return 0.0;
      const double rank = std::ceil(p * static_cast<double>(ms.size()));
      return ms[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
    };
    std::printf("%-34s %-22s %5zu %5d %8.3f %8.3f %8.3f %8.3f %8.3f\n",
                scenario.c_str(), stage, ms.size(), lost, percentile(0.5),
                percentile(0.95), percentile(0.99), percentile(0.999),
                percentile(1));
    std::fflush(stdout);
    if (csv_.is_open()) {
      csv_ << '"' << scenario << "\"," << stage << ',' << ms.size() << ','
           << lost << ',' << percentile(0.5) << ',' << percentile(0.95) << ','
           << percentile(0.99) << ',' << percentile(0.999) << ','
           << percentile(1) << '\n';
    }
  }

  Arguments arguments_;
  testing::TestBus buses_;
  testing::TempFolder folder_;
  Requester requester_;
  std::vector<std::unique_ptr<ChildProcess>> processes_;
  std::ofstream csv_;
};

Cell ParseCell(const std::string& text) {
  Cell cell;
  char end = 0;
  if (std::sscanf(text.c_str(), "%d,%d%c", &cell.x, &cell.y, &end) != 2) {
    throw std::runtime_error("'" + text + "' is no point; write X,Y");
  }
  return cell;
}

}  // namespace
}  // namespace terra

int main(int argc, char** argv) {
  terra::Arguments arguments;
  CLI::App app("Measures the deployed path over LCM with real processes.");
  app.option_defaults()->always_capture_default();
  app.add_option("--requests", arguments.requests, "per scenario")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--rate", arguments.rate_hz, "requests per second")
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--map", arguments.map);
  app.add_option("--start", arguments.start);
  app.add_option("--goal", arguments.goal);
  app.add_option("--csv", arguments.csv, "also write the table here");
  CLI11_PARSE(app, argc, argv);
  try {
    terra::Bench bench(arguments, terra::ParseCell(arguments.start),
                       terra::ParseCell(arguments.goal));
    bench.RunAll();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bus_latency: %s\n", error.what());
    return 1;
  }
  return 0;
}
