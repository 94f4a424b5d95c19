// SPDX-License-Identifier: MIT
// Pictures to disk while the next frame renders.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "lodestone/image/image.h"

namespace lodestone::app {

// One thread that encodes and writes, in the order of push(). After an image could not be written, the ones
// behind it are dropped.
class FrameWriter {
 public:
  FrameWriter();
  ~FrameWriter();  // writes what is queued; an error that nobody asked for is lost
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  // Waits while the queue is full. Throws the first error of an earlier image.
  void push(std::filesystem::path path, image::Image image);
  // Waits until all is written. Throws the first error.
  void finish();

 private:
  struct Job {
    std::filesystem::path path;
    image::Image image;
  };
  void work();
  void rethrow_first_error();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> queue_;
  bool busy_ = false, stop_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace lodestone::app
