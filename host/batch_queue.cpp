// SPDX-License-Identifier: MIT
#include "lodestone/host/batch_queue.h"

#include <iterator>
#include <utility>

namespace lodestone::host {

namespace {
constexpr size_t max_in_flight = 3;
}

BatchQueue::BatchQueue(const Device& device, MemoryAllocator& memory, uint32_t passes_per_batch,
                       bool counting)
    : device_(device), memory_(memory), passes_per_batch_(passes_per_batch), counting_(counting) {}

BatchQueue::~BatchQueue() {
  // A lost device has finished, too.
  vkDeviceWaitIdle(device_.handle());
}

Batch& BatchQueue::recording() {
  if (recording_) return *recording_;
  if (idle_.empty()) {
    recording_ = std::make_unique<Batch>(device_, memory_, passes_per_batch_, counting_);
  } else {
    recording_ = std::move(idle_.back());
    idle_.pop_back();
  }
  recording_->begin(++last_begun_);
  return *recording_;
}

Batch& BatchQueue::youngest() {
  return recording_ ? *recording_ : *in_flight_.back();
}

void BatchQueue::submit() {
  if (!recording_) return;
  in_flight_.push_back(std::move(recording_));
  in_flight_.back()->submit();
  if (in_flight_.size() > max_in_flight) wait_for_oldest();
}

void BatchQueue::wait_for_oldest() {
  std::vector<render::PassRecord> records = in_flight_.front()->wait(origin_);
  records_.insert(records_.end(), std::make_move_iterator(records.begin()),
                  std::make_move_iterator(records.end()));
  completed_ = in_flight_.front()->serial();
  idle_.push_back(std::move(in_flight_.front()));
  in_flight_.pop_front();
}

void BatchQueue::wait_all() {
  submit();
  while (!in_flight_.empty()) wait_for_oldest();
}

std::vector<render::PassRecord> BatchQueue::take_records() {
  return std::exchange(records_, {});
}

}  // namespace lodestone::host
