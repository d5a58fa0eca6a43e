#include "pipeline/decode/stripe_planes.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace bodyscan {
namespace {

constexpr int rows_a_task = 64;

struct AddFineBit {
  BODYSCAN_KERNEL void run(int width, int bit, const std::int16_t* difference, std::uint16_t* gray,
                           std::int16_t* fine) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      gray[x] = static_cast<std::uint16_t>(gray[x] | ((difference[x] > 0 ? 1U : 0U) << bit));
      fine[x] = difference[x];
    }
  }
};

struct AddCoarseBit {
  BODYSCAN_KERNEL void run(int width, int bit, const std::int16_t* difference, std::uint16_t* gray,
                           std::uint16_t* coarse) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      gray[x] = static_cast<std::uint16_t>(gray[x] | ((difference[x] > 0 ? 1U : 0U) << bit));
      const auto size = static_cast<std::uint16_t>(difference[x] < 0 ? -difference[x] : difference[x]);
      coarse[x] = size < coarse[x] ? size : coarse[x];
    }
  }
};

// Sampled pixels before the given row or column.
std::size_t samples_of(int pixels) {
  return static_cast<std::size_t>((pixels + StripePlanes::plateau_step - 1) / StripePlanes::plateau_step);
}

template <class Pixel>
void subtract(int width, const Pixel* pattern, const Pixel* inverse, const std::uint16_t* linear,
              std::int16_t* difference) {
  for (int x = 0; x < width; ++x)
    difference[x] = static_cast<std::int16_t>(linear[pattern[x]] - linear[inverse[x]]);
}

template <class Pixel>
void subtract_middle(int width, const Pixel* pattern, const std::uint16_t* middle,
                     const std::uint16_t* linear, std::int16_t* difference) {
  for (int x = 0; x < width; ++x)
    difference[x] = static_cast<std::int16_t>(2 * linear[pattern[x]] - middle[x]);
}

}  // namespace

StripePlanes::StripePlanes(Size camera, int count, int finest_bit)
    : bit_count(count), gray(camera, 0), coarse(camera, std::numeric_limits<std::uint16_t>::max()) {
  for (int bit = finest_bit; bit < fine_bits; ++bit)
    fine[static_cast<std::size_t>(bit)] = Image<std::int16_t>(camera, 0);
}

void StripePlanes::rescale(const Image<std::uint16_t>& before, const Image<std::uint16_t>& now) {
  constexpr std::uint16_t unset = std::numeric_limits<std::uint16_t>::max();
  for (std::size_t i = 0; i < coarse.size().area(); ++i) {
    const float scale =
        static_cast<float>(now.data()[i]) / std::max(static_cast<float>(before.data()[i]), 1.0F);
    const auto scaled = [&](auto value, float most) {
      return static_cast<decltype(value)>(std::clamp(static_cast<float>(value) * scale, -most, most));
    };
    if (coarse.data()[i] != unset) coarse.data()[i] = scaled(coarse.data()[i], unset - 1);
    for (auto& plane : fine)
      plane.data()[i] = scaled(plane.data()[i], std::numeric_limits<std::int16_t>::max());
  }
  for (auto& samples : plateau) samples.clear();
}

// The samples of the first of the coarsest bits that are still missing, made room for.
std::vector<std::uint16_t>* StripePlanes::plateau_to_fill() {
  const auto missing = std::ranges::find_if(plateau, [](const auto& samples) { return samples.empty(); });
  if (missing == plateau.end()) return nullptr;
  missing->resize(samples_of(gray.width()) * samples_of(gray.height()));
  return &*missing;
}

// subtract(y, difference) fills one row of pattern minus inverse.
template <class Subtract>
void StripePlanes::add_rows(int bit, const Subtract& subtract) {
  const int width = gray.width();
  std::vector<std::uint16_t>* samples = bit >= fine_bits ? plateau_to_fill() : nullptr;
  parallel_for(0, gray.height(), rows_a_task, [&](int first, int last) {
    std::vector<std::int16_t> buffer(static_cast<std::size_t>(width));
    for (int y = first; y < last; ++y) {
      subtract(y, buffer.data());
      const std::int16_t* difference = buffer.data();
      if (bit < fine_bits)
        run_kernel<AddFineBit>(width, bit, difference, gray.row(y),
                               fine[static_cast<std::size_t>(bit)].row(y));
      else
        run_kernel<AddCoarseBit>(width, bit, difference, gray.row(y), coarse.row(y));
      if (samples == nullptr || y % plateau_step != 0) continue;
      std::uint16_t* sample = samples->data() + samples_of(y) * samples_of(width);
      for (int x = 0; x < width; x += plateau_step)
        *sample++ = static_cast<std::uint16_t>(std::abs(static_cast<int>(difference[x])));
    }
  });
}

void StripePlanes::add(int bit, const Luma& pattern, const Luma& inverse,
                       std::span<const std::uint16_t> linear) {
  std::visit(
      [&](const auto& lit) {
        const auto& dark = std::get<std::decay_t<decltype(lit)>>(inverse);
        add_rows(bit, [&](int y, std::int16_t* difference) {
          subtract(gray.width(), lit.row(y), dark.row(y), linear.data(), difference);
        });
      },
      pattern);
}

void StripePlanes::add_against(int bit, const Luma& pattern, const Image<std::uint16_t>& middle,
                               std::span<const std::uint16_t> linear) {
  std::visit(
      [&](const auto& lit) {
        add_rows(bit, [&](int y, std::int16_t* difference) {
          subtract_middle(gray.width(), lit.row(y), middle.row(y), linear.data(), difference);
        });
      },
      pattern);
}

}  // namespace bodyscan
