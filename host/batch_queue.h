// SPDX-License-Identifier: MIT
// Batches on their way to the device: one being recorded, some in flight, others to be used again.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "lodestone/host/batch.h"

namespace lodestone::host {

class BatchQueue {
 public:
  BatchQueue(const Device& device, MemoryAllocator& memory, uint32_t passes_per_batch, bool counting);
  ~BatchQueue();  // waits

  // The batch to record into; begun where there was none.
  Batch& recording();
  bool is_recording() const { return recording_ != nullptr; }
  // Gives the recorded batch to the device; waits for the oldest where too many are in flight.
  void submit();
  // Submits, and waits for everything.
  void wait_all();

  // Batches are numbered from 1; all up to `completed()` have finished.
  uint64_t completed() const { return completed_; }
  // The number of the last batch that was begun.
  uint64_t last_begun() const { return last_begun_; }
  Batch& youngest();  // the batch of that number; only while it has not finished

  std::vector<render::PassRecord> take_records();
  HostClock::time_point origin() const { return origin_; }

 private:
  void wait_for_oldest();

  const Device& device_;
  MemoryAllocator& memory_;
  uint32_t passes_per_batch_;
  bool counting_;
  HostClock::time_point origin_ = HostClock::now();
  uint64_t completed_ = 0, last_begun_ = 0;
  std::unique_ptr<Batch> recording_;
  std::deque<std::unique_ptr<Batch>> in_flight_;
  std::vector<std::unique_ptr<Batch>> idle_;
  std::vector<render::PassRecord> records_;
};

}  // namespace lodestone::host
