#include "app/command_line.hpp"
#include "app/console.hpp"
#include "pipeline/base/atomic_file.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/board/board_limits.hpp"
#include "pipeline/drawing/page_writer.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

constexpr double max_paper_mm = 5000;  // a PDF page has at most 14400 points (5080 mm)

struct BoardOptions {
  PrintedBoard board;
  std::filesystem::path output;  // PDF or SVG, written
  std::string paper = "a4";
};

// ISO 216's, or "WIDTHxHEIGHT" in mm.
std::optional<Eigen::Vector2d> paper_mm(const std::string& name) {
  if (name == "a4") return Eigen::Vector2d(210, 297);
  if (name == "a3") return Eigen::Vector2d(297, 420);
  if (name == "a2") return Eigen::Vector2d(420, 594);
  Eigen::Vector2d size;
  const char* const end = name.data() + name.size();
  const auto width = std::from_chars(name.data(), end, size.x());
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
  const auto height = std::from_chars(width.ptr + 1, end, size.y());
  const bool valid = height.ec == std::errc() && height.ptr == end && size.allFinite() &&
                     size.minCoeff() > 0 && size.maxCoeff() <= max_paper_mm;
  return valid ? std::optional(size) : std::nullopt;
}

bool is_pdf(const std::filesystem::path& path) {
  return path.extension() == ".pdf";
}

Expected<void> run(const BoardOptions& options) {
  const Expected<BoardPage> page = printable_board(options.board, paper_mm(options.paper).value());
  if (!page) return tl::unexpected(page.error().within("--paper"));
  Expected<AtomicFile> file = AtomicFile::create(options.output);
  if (!file) return tl::unexpected(file.error());
  const std::string content = is_pdf(options.output) ? to_pdf(*page) : to_svg(*page);
  if (Expected<void> written = file->write(content); !written) return written;
  if (Expected<void> committed = file->commit(Durability::process); !committed) return committed;
  return print_result(options.output.string() + ": " + short_text(page->size_mm.x(), 1) + " x " +
                      short_text(page->size_mm.y(), 1) + " mm, " + short_text(page->white_mm, 1) +
                      " mm of white around the board; print it at 100 % and measure the ruler\n");
}

CLI::Validator valid_if(const std::function<bool(const std::string&)>& valid, const std::string& rule,
                        const std::string& type) {
  return {[valid, rule](const std::string& text) { return valid(text) ? std::string() : rule; }, type};
}

}  // namespace

void add_board_command(CLI::App& app, Action& action) {
  const auto options = std::make_shared<BoardOptions>();
  CLI::App& command =
      *app.add_subcommand("board", "Make a chessboard to print, for the calibration (PDF, SVG).");
  const CLI::Range corners(min_board_corners, max_board_corners);
  command.add_option("--columns", options->board.columns, "Inner corners along the board's width")
      ->required()
      ->check(corners);
  command.add_option("--rows", options->board.rows, "Inner corners along the board's height")
      ->required()
      ->check(corners);
  const auto is_side = [](const std::string& text) {
    double mm = 0;
    return CLI::detail::lexical_cast(text, mm) && mm >= min_square_mm && mm < max_square_mm;
  };
  command.add_option("--square-mm", options->board.square_mm, "Side of a square (mm)")
      ->required()
      ->check(valid_if(is_side, "must be 0.1 to 1000 mm", "MM"));
  const auto has_format = [](const std::string& path) {
    return is_pdf(path) || std::filesystem::path(path).extension() == ".svg";
  };
  command.add_option("--output", options->output, "File to write; its name ends in .pdf or .svg")
      ->required()
      ->check(valid_if(has_format, "must end in .pdf or .svg", "FILE"));
  const auto is_paper = [](const std::string& name) { return paper_mm(name).has_value(); };
  command.add_option("--paper", options->paper, "a4, a3, a2, or WIDTHxHEIGHT in mm; turned as suits better")
      ->capture_default_str()
      ->check(valid_if(is_paper, "must be a4, a3, a2 or WIDTHxHEIGHT in mm, at most 5000", "PAPER"));
  command.callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace bodyscan
