// SPDX-License-Identifier: MIT
#include "lodestone/app/frame_writer.h"

#include <utility>

namespace lodestone::app {
namespace {

constexpr size_t queue_length = 2;  // pictures in memory beside the one being written

}  // namespace

FrameWriter::FrameWriter() : thread_([this] { work(); }) {}

FrameWriter::~FrameWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::rethrow_first_error() {
  if (error_ != nullptr) std::rethrow_exception(error_);
}

void FrameWriter::push(std::filesystem::path path, image::Image image) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return queue_.size() < queue_length || error_ != nullptr; });
  rethrow_first_error();
  queue_.push_back({std::move(path), std::move(image)});
  changed_.notify_all();
}

void FrameWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (queue_.empty() && !busy_) || error_ != nullptr; });
  rethrow_first_error();
}

void FrameWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return !queue_.empty() || stop_; });
    if (queue_.empty()) return;
    Job job = std::move(queue_.front());
    queue_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr error;
    try {
      image::write(job.path, job.image);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (error != nullptr) {
      error_ = error;
      queue_.clear();
      changed_.notify_all();
      return;
    }
    changed_.notify_all();
  }
}

}  // namespace lodestone::app
