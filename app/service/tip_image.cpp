#include "service/tip_image.hpp"

#include "service/reply.hpp"

namespace interlock {
namespace {

Problem no_biopsy() {
  return {.status = Status::conflict,
          .code = "NO_BIOPSY",
          .detail = "No biopsy is open, so nobody takes images of the needle.",
          .expected = "an open biopsy",
          .next_step = "Propose one by POST /api/proposals."};
}

Problem no_frame() {
  return {.status = Status::conflict,
          .code = "NO_FRAME",
          .detail =
              "The target of the open biopsy was given in the guide frame, so nobody knows where that "
              "lies in the scanner.",
          .expected = "points in the guide frame, or a biopsy at the target of the targeting",
          .next_step = "Propose the biopsy without target_mm."};
}

}  // namespace

tl::expected<void, Problem> show_tip_image(const Context& context, const TipImage& image) {
  const ControlView& view = context.view();
  const Proposal* open = context.registry.open_biopsy();
  if (open == nullptr) {
    return fail(no_biopsy());
  }
  const BiopsyTask& insertion = *open->work<BiopsyTask>();
  Pose guide_from_image = Pose::Identity();
  if (image.frame == ImageFrame::scanner) {
    if (!insertion.scanner_from_guide) {
      return fail(no_frame());
    }
    guide_from_image = insertion.scanner_from_guide->inverse();
  }
  const std::uint32_t ticks = view.snapshot.state.system.tick - insertion.start_tick;
  NeedleImage seen;
  seen.time_s = ticks * (context.robot.period_us * 1e-6) - image.age_ms * 1e-3;
  seen.tip_mm = guide_from_image * image.tip_mm;
  if (image.target_mm) {
    seen.target_mm = guide_from_image * *image.target_mm;
  }
  if (!context.registry.show_image(seen)) {
    return fail(Problem{.status = Status::service_unavailable,
                        .code = "OVERLOADED",
                        .detail = "The control thread takes no more images now.",
                        .next_step = "Send the next one."});
  }
  return {};
}

}  // namespace interlock
