#include "app/scan/live_decoder.hpp"

#include "pipeline/base/size_text.hpp"
#include "pipeline/image/codec.hpp"

#include <algorithm>
#include <exception>
#include <string>

namespace bodyscan {

LiveDecoder::LiveDecoder(PatternSequence sequence, Size camera, const DecodeOptions& options)
    : sequence_(std::move(sequence)), camera_(camera), options_(options) {
  photographs_.resize(sequence_.patterns.size() + 1);
  accepted_.resize(photographs_.size());
}

LiveDecoder::~LiveDecoder() {
  abandon();
}

void LiveDecoder::abandon() {
  {
    const std::lock_guard lock(mutex_);
    shots_.clear();
  }
  stop();
}

bool LiveDecoder::complete() const {
  return std::ranges::none_of(photographs_, [](const Photograph& one) { return one.file.empty(); });
}

void LiveDecoder::stop() {
  {
    const std::lock_guard lock(mutex_);
    complete_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LiveDecoder::begin(ShotList& list, const std::vector<int>& wanted) {
  stop();
  list_ = &list;
  for (const int pattern : wanted) accepted_[static_cast<std::size_t>(pattern)] = false;
  const ToneResponse response = options_.response.value_or(ToneResponse{});
  std::vector<Pattern> patterns = sequence_.patterns;
  if (!check_) {
    patterns.push_back({.kind = PatternKind::white});
    check_.emplace(patterns, response);
  }
  motion_.emplace(sequence_.patterns, response);
  decoder_.reset();
  decompressed_.clear();
  used_ = 0;
  shots_.clear();
  complete_ = false;
  thread_ = std::thread([this] { work(); });
}

void LiveDecoder::hand_over(const PlannedShot& shot, Photograph photograph) {
  {
    const std::lock_guard lock(mutex_);
    shots_.push_back({shot, std::move(photograph)});
  }
  changed_.notify_all();
}

Expected<DecodedShots> LiveDecoder::finish() {
  stop();
  if (const Expected<void> shot = list_->outcome(); !shot) return tl::unexpected(shot.error());
  if (used_ < pattern_count()) return device_error("camera: the sequence was not shot to its end");
  Expected<Correspondence> correspondence = decoder_->finish();
  if (!correspondence) return tl::unexpected(correspondence.error());
  return DecodedShots{std::move(*correspondence), motion_->motion()};
}

void LiveDecoder::work() {
  for (;;) {
    Shot shot;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return complete_ || !shots_.empty(); });
      if (shots_.empty()) return;
      shot = std::move(shots_.front());
      shots_.pop_front();
    }
    try {
      const Expected<void> done = judge(shot).and_then([&] { return use_ready(); });
      if (!done) list_->fail(done.error());
    } catch (const std::exception& error) {
      list_->fail({ErrorKind::device, std::string("decoding the photographs: ") + error.what()});
    }
  }
}

Expected<void> LiveDecoder::judge(const Shot& shot) {
  const int pattern = shot.planned.pattern;
  Expected<Luma> luma = decode_luma(shot.photograph.file);
  if (!luma) {
    list_->refuse(pattern, {pattern}, luma.error().message);
    return {};
  }
  if (size_of(*luma) != camera_)
    return device_error("camera: its pictures are " + text_of(size_of(*luma)) + ", the calibration is for " +
                        text_of(camera_));
  if (list_->outdated(shot.planned)) {
    check_->skip(*luma);
    list_->put_back({pattern, false, 0});
    return {};
  }
  if (shot.planned.discard_first) check_->forget_shot_before();
  if (const auto fault = check_->check(pattern, *luma)) {
    for (const int again : fault->again) accepted_[static_cast<std::size_t>(again)] = false;
    list_->refuse(pattern, fault->again, fault->reason);
    return {};
  }
  photographs_[static_cast<std::size_t>(pattern)] = shot.photograph;
  accepted_[static_cast<std::size_t>(pattern)] = true;
  if (decompressed_.size() > 1) decompressed_.clear();
  decompressed_.insert_or_assign(pattern, std::move(*luma));
  list_->accept();
  return {};
}

// White comes with black and a pattern with its inverse: only together are they known to be right.
int LiveDecoder::last_of_unit(int pattern) const {
  if (pattern == 0) return 1;
  const auto next = static_cast<std::size_t>(pattern) + 1;
  return next < sequence_.patterns.size() && sequence_.patterns[next].inverted ? pattern + 1 : pattern;
}

Expected<void> LiveDecoder::use_ready() {
  while (used_ < pattern_count()) {
    const int last = last_of_unit(used_);
    for (int pattern = used_; pattern <= last; ++pattern)
      if (!accepted_[static_cast<std::size_t>(pattern)]) return {};
    for (; used_ <= last; ++used_)
      if (Expected<void> done = use(used_); !done) return done;
  }
  return {};
}

Expected<void> LiveDecoder::use(int pattern) {
  const auto index = static_cast<std::size_t>(pattern);
  Frame frame;
  if (const auto known = decompressed_.find(pattern); known != decompressed_.end()) {
    frame.luma = std::move(known->second);
    decompressed_.erase(known);
  } else {
    Expected<Luma> luma = decode_luma(photographs_[index].file);
    if (!luma) return tl::unexpected(luma.error());
    frame.luma = std::move(*luma);
  }
  motion_->look(pattern, frame.luma);
  if (index == sequence_.patterns.size()) return {};
  frame.pattern = sequence_.patterns[index];
  if (!decoder_) {
    Expected<Decoder> decoder = Decoder::create(sequence_, options_);
    if (!decoder) return tl::unexpected(decoder.error());
    decoder_.emplace(std::move(*decoder));
  }
  return decoder_->consume(frame);
}

}  // namespace bodyscan
