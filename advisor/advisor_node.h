#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "advisor/advice_worker.h"
#include "advisor/anchor.h"
#include "advisor/backend.h"
#include "bus/map_receiver.h"
#include "bus/node.h"

namespace terra::advisor {

/// An advisor on the bus: listens to map and BASELINE, and to DEPLOYED, POSE
/// and VERDICT for a robot that moves; publishes ADVICE on the advice bus when
/// its backend has an answer, and then once a second while the baseline stands.
/// A newer baseline or map cancels the work for the old one; so does a robot
/// that passes the anchor, and then the work begins again further ahead.
class AdvisorNode : public bus::Node {
 public:
  /// `out` sends on the advice bus.
  AdvisorNode(std::string name, std::unique_ptr<Backend> backend,
              bus::Outbox& out, std::function<void()> wake);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override;
  void AddCounters(bus::Counters& counters) const override;

 private:
  void OnBaseline(const terra_msg::baseline_t& message, bus::Time now);
  void OnDeployed(const terra_msg::deployed_t& message, bus::Time now);
  void OnPose(const terra_msg::pose_t& message, bus::Time now);
  void OnVerdict(const terra_msg::verdict_t& message, bus::Time now);
  void Begin(bus::Time now);
  void StartFrom(const Anchor& anchor, bus::Time now);
  void FollowRobot(bus::Time now);
  void Publish(const AdviceWorker::Finished& done, bus::Time now);

  std::string name_;
  bus::Outbox& out_;
  bus::MapReceiver map_;
  bus::SenderTracker planner_;
  bus::SenderTracker gate_;
  terra_msg::baseline_t baseline_{};
  double cell_size_m_ = 1;
  AnchorChooser anchors_;
  AnswerTime answer_time_;
  // What the backend works on, or waits for the robot to be ready for.
  enum class Work { kNone, kWaiting, kRunning, kAnswered };
  Work work_ = Work::kNone;
  Anchor anchor_;
  bus::Time began_{};
  bus::Time again_at_ = bus::kNever;  ///< After a verdict `late`.
  std::vector<terra_msg::advice_t> current_;
  bus::Periodic repeat_{bus::kSlowPeriod};
  std::int64_t jobs_ = 0;
  std::int64_t answers_ = 0;
  std::int64_t failures_ = 0;
  std::int64_t passed_ = 0;  ///< Jobs begun again because the robot was faster.
  std::string last_error_;
  AdviceWorker worker_;  // last: its thread may call wake
};

}  // namespace terra::advisor
