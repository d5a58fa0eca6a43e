#include "app/reconstruct.hpp"

#include "app/interrupt.hpp"
#include "app/model_making.hpp"
#include "app/reconstruct_inputs.hpp"
#include "app/version.hpp"
#include "hal/replay/frame_reader.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/decoder.hpp"

namespace bodyscan {
namespace {

Expected<Correspondence> decode(const ReconstructInputs& inputs, const ModelMaking& run) {
  const CaptureFolder& capture = inputs.capture;
  const auto name_folder = [&](const Error& error) { return error.within(run.source); };
  PatternSequence sequence{capture.manifest().projector, {}};
  for (const ManifestFrame& frame : capture.manifest().frames) sequence.patterns.push_back(frame.pattern);
  DecodeOptions options;
  options.response = capture.manifest().response;
  Expected<Decoder> decoder = Decoder::create(std::move(sequence), options).map_error(name_folder);
  if (!decoder) return tl::unexpected(decoder.error());
  int frames = 0;
  const Expected<void> read = for_each_frame(capture, [&](const Frame& frame) {
    run.progress.show("reading photograph", ++frames, capture.frame_count());
    return check_interrupt().and_then([&] { return decoder->consume(frame).map_error(name_folder); });
  });
  if (!read) return tl::unexpected(read.error());
  Expected<Correspondence> correspondence = decoder->finish().map_error(name_folder);
  run.clock.end_stage("decode");
  return correspondence;
}

Expected<WhiteAndBlack> load_photographs(const CaptureFolder& capture) {
  Expected<ColorImage8> white;
  Expected<ColorImage8> black;
  parallel_for(0, 2, 1, [&](int begin, int) {
    if (begin == 0) white = capture.load_white_color();
    if (begin == 1) black = capture.load_black_color();
  });
  if (!white) return tl::unexpected(white.error());
  if (!black) return tl::unexpected(black.error());
  return WhiteAndBlack{std::move(*white), std::move(*black)};
}

Expected<void> make_model(const ReconstructInputs& inputs, const ModelMaking& run) {
  Expected<Correspondence> correspondence = decode(inputs, run);
  if (!correspondence) return tl::unexpected(correspondence.error());
  if (Expected<void> drawn = draw_rows(run, *correspondence); !drawn) return drawn;
  Expected<PointGrid> points = make_points(run, *correspondence);
  if (!points) return tl::unexpected(points.error());
  *correspondence = {};
  const Expected<GridMesh> mesh = make_surface(run, std::move(*points));
  if (!mesh) return tl::unexpected(mesh.error());
  if (Expected<void> going_on = run.begin("colouring"); !going_on) return going_on;
  const Expected<WhiteAndBlack> photographs = load_photographs(inputs.capture);
  if (!photographs) return tl::unexpected(photographs.error());
  return save_model(run, *mesh, *photographs);
}

}  // namespace

Expected<ModelReport> reconstruct(const ReconstructOptions& options, Progress& progress) {
  StageClock clock;
  const Expected<ReconstructInputs> inputs = open_inputs(options);
  if (!inputs) return tl::unexpected(inputs.error());
  ModelReport report;
  report.software = software_version();
  report.calibration = inputs->calibration.name;
  Expected<ModelFiles> files = ModelFiles::open(
      options.model, {report.calibration, report.software, /*comment=*/{}, /*closed=*/false});
  if (!files) return tl::unexpected(files.error());
  clock.end_stage("open");

  const ModelMaking run{options.model, inputs->calibration, options.capture.string(), *files, progress, clock,
                        report};
  if (const Expected<void> made = make_model(*inputs, run); !made) return tl::unexpected(made.error());
  finish_report(run);
  if (const Expected<void> committed = commit_model(run, to_json(report)); !committed)
    return tl::unexpected(committed.error());
  return report;
}

}  // namespace bodyscan
