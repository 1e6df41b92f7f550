#include <algorithm>
#include <string>

#include "render/gl/framebuffer_check.h"
#include "render/gl/shader_library.h"
#include "render/globe_renderer.h"

// From the picture of a frame to the caller's framebuffer, with or without samples.
namespace terrella {

// A driver may have fewer samples in textures than in other framebuffers.
Status GlobeRenderer::fit_targets(const FrameInput& input, PictureMemory& memory, GLuint framebuffer) {
  const auto refuse = [](const Status& wrong) { return Error{"Globe::render: " + wrong.error().message}; };
  if (Status good = check_framebuffer(framebuffer); !good) return refuse(good);
  if (framebuffer != memory.framebuffer || !memory.targets) {
    if (Status good = check_colors(framebuffer); !good) return refuse(good);
    memory.framebuffer = framebuffer;
  }
  GLint samples = 0, most_color = 0, most_depth = 0;
  glGetNamedFramebufferParameteriv(framebuffer, GL_SAMPLES, &samples);
  if (samples > 1) {
    glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &most_color);
    glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most_depth);
    if (const GLint most = std::min(most_color, most_depth); samples > most) {
      return Error{"Globe::render: the framebuffer has " + std::to_string(samples) +
                   " samples a pixel, and textures of this driver have at most " + std::to_string(most) +
                   "; draw into a framebuffer with no more samples"};
    }
    if (Status s = prepare_copy(color_samples_copy_, "copy_color.frag", true); !s) return s;
  }
  const bool selective = objects_ && input.surface.from_below == SurfaceFromBelow::selective;
  const bool through = input.sky && input.surface.alpha < 1.0;
  const Status fits = fit_targets({.size = input.size,
                                   .has_stencil = through || selective || input.stereo == Stereo::interlaced,
                                   .samples = samples > 1 ? samples : 0},
                                  memory);
  targets_ = memory.targets.get();
  return fits ? fits : refuse(fits);
}

// Frames are drawn one after the other, so pictures of equal form take turns in the same targets.
Status GlobeRenderer::fit_targets(const FrameTargets::Form& form, PictureMemory& memory) {
  if (memory.targets && memory.targets->form() == form) return Done{};
  std::erase_if(all_targets_, [](const auto& targets) { return targets.expired(); });
  for (const auto& targets : all_targets_) {
    if (auto held = targets.lock(); held->form() == form) {
      memory.targets = std::move(held);
      return Done{};
    }
  }
  memory.targets.reset();  // first, so that there is room for the new ones
  auto made = std::make_shared<FrameTargets>();
  if (Status fits = made->fit(form); !fits) return fits;
  all_targets_.push_back(made);
  memory.targets = std::move(made);
  return Done{};
}

void GlobeRenderer::hand_over(const FrameInput& input, GLuint framebuffer) {
  apply({});  // a scissor would cut the copy
  if (targets_->samples() == 0) return targets_->copy_to(framebuffer, input.corner_px);
  copy_samples(color_samples_copy_, targets_->color_samples(), framebuffer, {}, *targets_, input.corner_px);
  targets_->resolve_depth();
}

Status GlobeRenderer::prepare_copy(gl::Program& program, std::string_view fragment, bool samples) {
  if (program) return Done{};
  return build_into(program, {{GL_VERTEX_SHADER, {"interlace.vert"}}, {GL_FRAGMENT_SHADER, {fragment}}},
                    {samples ? "SAMPLES" : "NO_SAMPLES"});
}

// The saved state of the caller has no multisampled textures: few frames bind one.
void GlobeRenderer::copy_samples(const gl::Program& program, GLuint texture, GLuint framebuffer, const DrawState& state,
                                 const FrameTargets& from, glm::ivec2 corner_px) {
  glActiveTexture(GL_TEXTURE0);
  GLint before = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D_MULTISAMPLE, &before);
  const gl::VertexArray nothing = gl::make_vertex_array();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(corner_px.x, corner_px.y, from.size().width_px, from.size().height_px);
  apply(state.with(program.name()));
  glUniform2i(0, corner_px.x, corner_px.y);
  glBindTextureUnit(0, texture);
  glBindSampler(0, 0);
  glBindVertexArray(nothing.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, static_cast<GLuint>(before));
}

Status GlobeRenderer::copy_depth(const FrameTargets& from, GLuint framebuffer, glm::ivec2 corner_px) {
  if (Status good = check_framebuffer(framebuffer); !good) return good;
  if (Status good = check_depth(framebuffer); !good) return good;
  GLint samples = 0;
  glGetNamedFramebufferParameteriv(framebuffer, GL_SAMPLES, &samples);
  const bool by_sample = from.samples() > 0 && samples == from.samples();
  gl::Program& program = by_sample ? depth_samples_copy_ : depth_copy_;
  if (Status s = prepare_copy(program, "copy_depth.frag", by_sample); !s) return s;
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  copy_samples(program, by_sample ? from.depth_samples() : from.depth(), framebuffer,
               {.depth = DepthState{.test = GL_ALWAYS}, .color = {false, false, false, false}}, from, corner_px);
  return Done{};
}

}  // namespace terrella
