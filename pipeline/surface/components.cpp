#include "pipeline/surface/components.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/surface/cells.hpp"
#include "pipeline/surface/corners.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

constexpr int band_rows = 128;

// Neighbouring points of one row that triangles join: columns [begin, end).
struct Run {
  int begin;
  int end;
};

// Disjoint sets of runs (Tarjan 1975), with path halving.
class DisjointSets {
 public:
  std::uint32_t add() {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    return parent_.back();
  }
  std::uint32_t find(std::uint32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void join(std::uint32_t p, std::uint32_t q) {
    p = find(p);
    q = find(q);
    if (p != q) parent_[std::max(p, q)] = std::min(p, q);
  }
  void append(const DisjointSets& other) {
    const auto base = static_cast<std::uint32_t>(parent_.size());
    for (const std::uint32_t parent : other.parent_) parent_.push_back(base + parent);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// The runs of consecutive rows, row after row.
struct Band {
  std::vector<Run> runs;
  std::vector<std::size_t> row_begin{0};  // into runs; one more than rows
  DisjointSets sets;

  [[nodiscard]] std::span<const Run> row(std::size_t y) const {
    return std::span(runs).subspan(row_begin[y], row_begin[y + 1] - row_begin[y]);
  }
};

struct LinkKernel {
  // 2 where a triangle of cell row y or the one above (null for the first row) uses point (x, y), 1 added
  // where one joins it to the point on its right. links[0] is column 0.
  BODYSCAN_KERNEL void run(const std::uint8_t* above, const std::uint8_t* here, int width,
                           std::uint8_t* links) {
    links[0] = static_cast<std::uint8_t>(corners::a(here[0]) << 1 | corners::top(here[0]));
    for (int x = 1; x < width; ++x) {
      const unsigned point = corners::a(here[x]) | corners::b(here[x - 1]);
      links[x] = static_cast<std::uint8_t>(point << 1 | corners::top(here[x]));
    }
    if (!above) return;
    links[0] = static_cast<std::uint8_t>(links[0] | corners::c(above[0]) << 1 | corners::bottom(above[0]));
    for (int x = 1; x < width; ++x) {
      const unsigned point = corners::c(above[x]) | corners::d(above[x - 1]);
      links[x] = static_cast<std::uint8_t>(links[x] | point << 1 | corners::bottom(above[x]));
    }
  }
};

void append_runs(std::span<const std::uint8_t> links, Band& band) {
  const int width = static_cast<int>(links.size());
  const auto at = [&](int x) { return links[static_cast<std::size_t>(x)]; };
  for (int x = 0; x < width; ++x) {
    if (at(x) == 0) continue;
    const int begin = x;
    while (at(x) & 1) ++x;
    band.runs.push_back({begin, x + 1});
    band.sets.add();
  }
  band.row_begin.push_back(band.runs.size());
}

// Joins the runs of two rows that the cells between them connect. `first` and `second` number their first
// runs.
void join_rows(const std::uint8_t* cells, int width, std::span<const Run> above, std::uint32_t first,
               std::span<const Run> below, std::uint32_t second, DisjointSets& sets) {
  std::size_t i = 0;
  std::size_t j = 0;
  for (int x = 0; x < width && i < above.size() && j < below.size(); ++x) {
    const unsigned code = cells[x];
    if (!(code & cell::full)) continue;
    const int top = x + !corners::a(code);
    const int bottom = x + !corners::c(code);
    while (i < above.size() && above[i].end <= top) ++i;
    while (j < below.size() && below[j].end <= bottom) ++j;
    if (i == above.size() || j == below.size()) return;
    sets.join(first + static_cast<std::uint32_t>(i), second + static_cast<std::uint32_t>(j));
    // The same two runs until one of them ends.
    x = std::max(x, std::min(above[i].end, below[j].end) - 2);
  }
}

Band label_band(const Image<std::uint8_t>& cells, int begin, int end) {
  const int width = cells.width();
  Band band;
  std::vector<std::uint8_t> links(static_cast<std::size_t>(width));
  for (int y = begin; y < end; ++y) {
    run_kernel<LinkKernel>(y > 0 ? cells.row(y - 1) : nullptr, cells.row(y), width, links.data());
    append_runs(links, band);
    if (y == begin) continue;
    const auto row = static_cast<std::size_t>(y - begin);
    join_rows(cells.row(y - 1), width, band.row(row - 1), static_cast<std::uint32_t>(band.row_begin[row - 1]),
              band.row(row), static_cast<std::uint32_t>(band.row_begin[row]), band.sets);
  }
  return band;
}

// All bands as one.
Band label(const Image<std::uint8_t>& cells) {
  const int height = cells.height();
  std::vector<Band> bands(static_cast<std::size_t>((height + band_rows - 1) / band_rows));
  parallel_for(0, static_cast<int>(bands.size()), 1, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      bands[static_cast<std::size_t>(i)] =
          label_band(cells, i * band_rows, std::min(height, (i + 1) * band_rows));
    }
  });
  Band all;
  for (Band& band : bands) {
    const std::size_t rows = all.row_begin.size() - 1;
    const std::size_t base = all.runs.size();
    all.runs.insert(all.runs.end(), band.runs.begin(), band.runs.end());
    for (std::size_t y = 1; y < band.row_begin.size(); ++y) all.row_begin.push_back(base + band.row_begin[y]);
    all.sets.append(band.sets);
    if (rows > 0) {
      join_rows(cells.row(static_cast<int>(rows) - 1), cells.width(), all.row(rows - 1),
                static_cast<std::uint32_t>(all.row_begin[rows - 1]), all.row(rows),
                static_cast<std::uint32_t>(all.row_begin[rows]), all.sets);
    }
    band = {};
  }
  return all;
}

void clear_run(const Run& run, std::uint8_t* cells) {
  // The two triangles of a cell share an edge, so they belong to one component.
  for (int x = run.begin; x < run.end; ++x) {
    if (corners::a(cells[x])) cells[x] = 0;
  }
  for (int x = std::max(run.begin, 1); x < run.end; ++x) {
    if (corners::b(cells[x - 1])) cells[x - 1] = 0;
  }
}

struct Component {
  std::size_t points = 0;
  double area_mm2 = 0;
  bool large = false;
  int continuations =
      0;  // ends of runs at which a large component goes on at the same depth, less the others
};

// The runs of all rows with the components they belong to.
class Census {
 public:
  Census(const PointGrid& grid, const Lens& camera, const ComponentOptions& options,
         const Image<std::uint8_t>& cells)
      : grid_(grid), camera_(camera), options_(options), all_(label(cells)), components_(all_.runs.size()) {
    for_each_run([&](int y, const Run& run, Component& component) { measure(y, run, component); });
    for (Component& component : components_)
      component.large = component.area_mm2 >= options_.min_component_mm2;
    for (std::size_t y = 0; y + 1 < all_.row_begin.size(); ++y) {
      for (std::size_t i = all_.row_begin[y] + 1; i < all_.row_begin[y + 1]; ++i) compare(y, i - 1, i);
    }
  }

  // visit(row, run, component) for all runs in raster order.
  template <class Visit>
  void for_each_run(const Visit& visit) {
    for (std::size_t y = 0; y + 1 < all_.row_begin.size(); ++y) {
      for (std::size_t i = all_.row_begin[y]; i < all_.row_begin[y + 1]; ++i) {
        visit(static_cast<int>(y), all_.runs[i], component_of(i));
      }
    }
  }

  [[nodiscard]] const std::vector<Component>& components() const { return components_; }

 private:
  Component& component_of(std::size_t run) {
    return components_[all_.sets.find(static_cast<std::uint32_t>(run))];
  }

  void measure(int y, const Run& run, Component& component) const {
    const double z = grid_.points(run.begin + (run.end - run.begin) / 2, y).z;
    component.points += static_cast<std::size_t>(run.end - run.begin);
    component.area_mm2 += (run.end - run.begin) * z * z / (camera_.fx * camera_.fy);
  }

  // Two runs that follow one another in row y, one of a large and one of a small component.
  void compare(std::size_t y, std::size_t left, std::size_t right) {
    constexpr double slope = 2;  // 63 degrees
    Component& p = component_of(left);
    Component& q = component_of(right);
    if (p.large == q.large) return;
    const int row = static_cast<int>(y);
    const double z = grid_.points(all_.runs[left].end - 1, row).z;
    const double other = grid_.points(all_.runs[right].begin, row).z;
    const double gap_mm = (all_.runs[right].begin - all_.runs[left].end + 1) * z / camera_.fx;
    if (gap_mm > options_.island_gap_mm) return;
    (p.large ? q : p).continuations += std::abs(z - other) <= slope * gap_mm ? 1 : -1;
  }

  const PointGrid& grid_;
  const Lens& camera_;
  const ComponentOptions& options_;
  Band all_;
  std::vector<Component> components_;  // as many as runs; those of the sets' representatives count
};

bool stays(const Component& component) {
  return component.large || component.continuations > 0;
}

}  // namespace

Expected<void> ComponentOptions::check() const {
  const auto refuse = [](const char* what) {
    return tl::unexpected(Error{ErrorKind::usage, std::string("components: ") + what});
  };
  if (!(min_component_mm2 >= 0)) return refuse("min_component_mm2: negative");
  if (!(island_gap_mm >= 0)) return refuse("island_gap_mm: negative");
  return {};
}

void remove_small_components(const PointGrid& grid, const Lens& camera, const ComponentOptions& options,
                             Image<std::uint8_t>& cells, ComponentReport& report) {
  report = {};
  if (cells.empty()) return;
  Census census(grid, camera, options, cells);
  for (const Component& component : census.components()) {
    if (component.points == 0) continue;
    if (stays(component)) {
      ++report.components;
    } else {
      ++report.small_components;
      report.small_component_points += component.points;
    }
  }
  census.for_each_run([&](int y, const Run& run, const Component& component) {
    if (!stays(component)) clear_run(run, cells.row(y));
  });
}

}  // namespace bodyscan
