#include "pipeline/base/median.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"

namespace bodyscan {

namespace fs = std::filesystem;

Expected<std::string> executable_part(const BenchOptions& options) {
  const fs::path stripped = options.work / "bodyscan_stripped";
  if (auto run = run_successfully({"strip", "-o", stripped.string(), BODYSCAN_EXECUTABLE}); !run) {
    return tl::unexpected(run.error());
  }
  constexpr int starts = 20;
  std::vector<double> start_ms;
  for (int i = 0; i < starts; ++i) {
    const Expected<ProcessUsage> usage = run_successfully({stripped.string(), "--version"});
    if (!usage) return tl::unexpected(usage.error());
    start_ms.push_back(1000 * usage->wall_s);
  }
  const double megabytes = static_cast<double>(fs::file_size(stripped)) * 1e-6;
  fs::remove(stripped);
  return "## Executable\n\n" +
         markdown_table({{"figure", "value"},
                         {"stripped size", fixed(megabytes, 2) + " MB"},
                         {"`bodyscan --version`, median of 20 runs", fixed(median(start_ms), 2) + " ms"}});
}

}  // namespace bodyscan
