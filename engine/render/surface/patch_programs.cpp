#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/shader_library.h"
#include "render/surface/patch_pass.h"

// The programs of patches, made when first needed.
namespace terrella {
namespace {
/// #defines of LayerRole.
constexpr std::string_view kRoleDefines[] = {"BASE_LAYER", "UPPER_LAYER", "SPECIAL_LAYER", "BLENDED_LAYER"};
/// #defines of TexelKind.
constexpr std::string_view kKindDefines[] = {"PICTURES", "NUMBERS", "DIRECTIONS"};
/// #defines by the number of layers of a stack.
constexpr std::string_view kStackDefines[PatchStacks::kMost + 1] = {"NO_STACK", "STACK 1", "STACK 2", "STACK 3",
                                                                    "STACK 4"};
constexpr std::string_view kFiles[PatchLayer::kAll] = {
    "patch_magnified.frag", "patch_plain.frag",      "patch_long.frag",  "patch_oblique.frag", "patch_polar_short.frag",
    "patch_polar.frag",     "patch_polar_long.frag", "patch_paper.frag", "patch_limb.frag",    "patch_limb.frag"};
bool is_polar(int program) {
  return program == PatchLayer::polar_limb || (program >= PatchLayer::polar_short && program < PatchLayer::limb);
}

/// Names in the files of a layer's look-ups that each layer of a stack has for itself.
constexpr std::string_view kOwnNames[] = {
    "main",          "window_size",   "slot_point",         "cell_at",
    "tap",           "known",         "with_lines",         "bilinear",
    "level_tap",     "mip_tap",       "bicubic_tap",        "cubic_weights",
    "tap_at",        "length_texels", "kBesidePole",        "WindowPoint",
    "kDegrees",      "in_meridian",   "ExactPoint",         "exact_point",
    "in_window",     "polar_mean",    "true_texels",        "kGolden",
    "kMostTapsLit",  "kMostOverTrue", "LimbPixel",          "limb_pixel",
    "inside_limb",   "on_ground",     "ground_point",       "kAtLimb",
    "number_colors", "tiles",         "exact_window_point", "kThreeBesidePole_texels"};
constexpr std::string_view kMacros[] = {"Texels",  "seen",   "precise_tap", "NUMBERS", "Imagery",
                                        "IMAGERY", "finish", "UPPER_LAYER", "BICUBIC", "AT_POLE"};

void redefine(std::string& text, std::string_view name, std::string_view value) {
  text.append("#undef ").append(name).append("\n#define ").append(name).append(" ").append(value).append("\n");
}

/// Text before the look-ups of layer k of a stack: its inputs, and its names. `main_k()` then sets `found_k`.
std::string slot_text(const StackProgram& program, std::size_t k, bool bicubic) {
  const StackProgram::Slot& slot = program.slots[k];
  const std::string own = "_" + std::to_string(k), at = "[" + std::to_string(k) + "]";
  const bool opaque = k == 0 && program.base;
  std::string text;
  for (std::string_view name : kMacros) text.append("#undef ").append(name).append("\n");
  for (std::string_view name : kOwnNames) redefine(text, name, std::string(name) + own);
  redefine(text, "tiles_precise", "tiles");
  redefine(text, "tiles_mipmapped", "tiles");
  redefine(text, "texels", "stack_texels" + at);
  redefine(text, "number_look", "stack_numbers" + at);
  redefine(text, "number_lines", "stack_lines" + at);
  redefine(text, slot.numbers ? "seen" : "precise_tap", slot.numbers ? "seen" + own : "precise_tap" + own);
  if (is_polar(slot.look)) text += "#define AT_POLE\n";
  if (slot.numbers) text += "#define NUMBERS\n";
  if (bicubic && !slot.numbers) text += "#define BICUBIC\n";
  if (k > 0) {
    redefine(text, "window_point", "window_point" + own);
    redefine(text, "window", "window" + own);
    redefine(text, "center_and_scale", "center_and_scale" + own);
  }
  text += opaque ? "#define Imagery vec3\n#define IMAGERY(texel) (texel).rgb\n"
                 : "#define UPPER_LAYER\n#define Imagery vec4\n#define IMAGERY(texel) (texel)\n";
  text += "in vec2 window_point;\nflat in uvec4 window;\nflat in vec4 center_and_scale;\nImagery found" + own + ";\n";
  text += "#define finish(imagery) found" + own + " = (imagery)\n";
  text.append("layout(binding = ")
      .append(std::to_string(PatchStacks::kTileUnits[k]))
      .append(") uniform sampler2DArray tiles;\n");
  text.append("layout(binding = ")
      .append(std::to_string(PatchStacks::kColorUnits[k]))
      .append(") uniform sampler2D number_colors;\n");
  return text;
}

/// main() of a stack.
std::string stack_main(const StackProgram& program) {
  std::string text = "#undef main\nvoid main() {\n  vec4 sum = vec4(0.0);\n";
  for (std::size_t k = 0; k < static_cast<std::size_t>(program.count); ++k) {
    const std::string own = std::to_string(k);
    text += "  main_" + own + "();\n  sum = ";
    const std::string look = "stack_look[" + own + "], ", numbers = program.slots[k].numbers ? "true" : "false";
    text += k == 0 && program.base
                ? "ground(found_0, " + look + numbers + ");\n"
                : "over(sum, found_" + own + ", stack_opacity[" + own + "], " + look + "stack_tone[" + own + "], " +
                      (program.slots[k].special ? "true, " : "false, ") + numbers + ");\n";
  }
  if (program.ground != 0) text += "  sum = under_objects(sum);\n";
  return text + "  color_srgb = sum;\n  WRITE_DEPTH(1.0);\n}\n";
}
}  // namespace

Status PatchPass::prepare(LayerRole role, TexelKind kind, const std::vector<SelectedPatch>& patches,
                          const std::vector<bool>& own) {
  ProgramSet& set = sets_[set_index(role, kind, light_of(role, kind))];
  const auto make = [&](int variant) -> Status {
    gl::Program& program = set.programs[variant];
    return program ? Status{Done{}} : make_program(program, variant, role, kind);
  };
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const SelectedPatch& patch = patches[k];
    if (!own.empty() && !own[k]) continue;
    if (Status made = make(variant_for(patch)); !made) return made;
    if (Status made = is_on_limb(patch) ? make(limb_variant_for(patch)) : Done{}; !made) return made;
  }
  return role == LayerRole::base ? Done{} : prepare_whole(Whole::black);
}

gl::Program& PatchPass::whole_program(Whole what, bool limb) {
  // The air before the ground is the same in every light; its vertices have slopes if those are lit.
  if (what == Whole::air)
    return sets_[set_index(LayerRole::base, TexelKind::pictures, {.relief = scene_.light.relief})].air;
  auto& programs = what == Whole::depth ? depth_programs_ : what == Whole::behind ? behind_programs_ : flat_programs_;
  return programs[limb ? 1 : 0];
}

Status PatchPass::prepare_whole(Whole what) {
  const std::string_view file = what == Whole::air      ? "patch_air.frag"
                                : what == Whole::depth  ? "patch_depth.frag"
                                : what == Whole::behind ? "patch_behind.frag"
                                                        : "patch_flat.frag";
  for (const bool limb : {false, true}) {
    gl::Program& program = whole_program(what, limb);
    if (program || (limb && !scene_.limb)) continue;
    if (Status made =
            build(program, {"frame.glsl", "air.glsl", file}, LayerRole::base, TexelKind::pictures, {.limb = limb});
        !made)
      return made;
  }
  return Done{};
}

Status PatchPass::build(gl::Program& place, std::vector<std::string_view> fragment, LayerRole role, TexelKind kind,
                        const Extras& extras) const {
  const PatchLight light = light_of(role, kind);
  return build_into(place,
                    {{GL_VERTEX_SHADER, {"frame.glsl", "regolith.glsl", "air_part.glsl", "patch.vert"}},
                     {GL_FRAGMENT_SHADER, std::move(fragment)}},
                    {depth_define(options_.depth),
                     light.relief ? "RELIEF" : "LEVEL_LIGHT",
                     options_.night_lights ? "DAY_AND_NIGHT" : "DAY_LIGHT",
                     extras.pole ? "AT_POLE" : "OFF_POLE",
                     extras.city_lights ? "CITY_LIGHTS" : "NO_LAMPS",
                     extras.limb ? "AT_LIMB" : "OFF_LIMB",
                     options_.regolith ? "REGOLITH" : "NO_DUST",
                     light.glint ? "GLINT" : "NO_GLINT",
                     light.bicubic ? "BICUBIC" : "BILINEAR",
                     scene_.air != nullptr ? "AIR" : "NO_AIR",
                     which() == 2 ? "NEAR_GROUND" : "FAR_FROM_GROUND",
                     functions_define(options_.functions.value_or(ShaderFunctions::driver)),
                     kRoleDefines[static_cast<int>(role)],
                     kKindDefines[static_cast<int>(kind)],
                     kStackDefines[extras.stack],
                     extras.ground != 0 ? "ON_GROUND" : "OFF_GROUND",
                     (extras.ground & 1U) != 0 || extras.ground == kMoreLines ? "AREAS" : "NO_AREAS",
                     (extras.ground & 2U) != 0 || extras.ground == kMoreLines ? "LINES" : "NO_LINES",
                     extras.ground == kMoreLines ? "MORE_LINES" : "ONE_LINE",
                     (extras.ground & 4U) != 0 ? "SLANTED" : "LEVEL",
                     extras.ground_alone ? "GROUND_ALONE" : "GROUND_BELOW",
                     has_relief_ ? "GROUND_CELLS 13" : "GROUND_CELLS 9"});
}

Status PatchPass::prepare(const PatchStacks& stacks) {
  for (const PatchStacks::Group& group : stacks.groups) {
    gl::Program& place = stack_programs_[stack_place(group.program)];
    if (place) continue;
    if (Status made = make_stack_program(place, StackProgram::of_key(group.program)); !made) return made;
  }
  return Done{};
}

// The files of a layer's look-ups come once for each layer.
Status PatchPass::make_stack_program(gl::Program& place, const StackProgram& program) {
  const auto slots = std::span(program.slots).first(static_cast<std::size_t>(program.count));
  Extras extras{.city_lights = program.night,
                .pole = std::ranges::any_of(slots, [](const auto& slot) { return is_polar(slot.look); }),
                .limb = slots[0].look >= PatchLayer::limb,
                .stack = program.count,
                .ground = program.ground};
  if (Status chosen = extras.pole ? choose_functions() : Done{}; !chosen) return chosen;
  std::vector<std::string_view> files = {"frame.glsl",        "functions.glsl",    "air.glsl",
                                         "patch_relief.glsl", "patch_common.glsl", "patch_stack.glsl"};
  if (program.ground != 0) files.emplace_back("patch_ground.glsl");
  std::vector<std::string> texts;
  texts.reserve(PatchStacks::kMost + 1);
  for (std::size_t k = 0; k < slots.size(); ++k) {
    files.emplace_back(texts.emplace_back(slot_text(program, k, scene_.light.bicubic)));
    files.insert(files.end(), {"patch_taps.glsl", "magnify.glsl"});
    if (is_polar(slots[k].look)) files.insert(files.end(), {"patch_exact_point.glsl", "patch_polar_taps.glsl"});
    files.emplace_back(kFiles[slots[k].look]);
  }
  files.emplace_back(texts.emplace_back(stack_main(program)));
  return build(place, std::move(files), program.base ? LayerRole::base : LayerRole::upper,
               program.base && slots[0].numbers ? TexelKind::numbers : TexelKind::pictures, extras);
}

// Coordinates that are computed per fragment need functions of enough accuracy.
Status PatchPass::choose_functions() {
  if (options_.functions) return Done{};
  const Result<ShaderFunctions> chosen = choose_shader_functions();
  if (!chosen) return chosen.error();
  options_.functions = *chosen;
  return Done{};
}

Status PatchPass::make_program(gl::Program& place, int variant, LayerRole role, TexelKind kind) {
  const int which = variant / 2;
  Extras extras{.city_lights = variant % 2 == 1, .limb = which >= PatchLayer::limb};
  extras.pole = is_polar(which);
  std::vector<std::string_view> files = {"frame.glsl", "air.glsl", "patch_relief.glsl", "patch_common.glsl"};
  if (role == LayerRole::blended) files.emplace_back("patch_blend.glsl");
  files.emplace_back("patch_taps.glsl");
  if (extras.pole) {
    if (Status chosen = choose_functions(); !chosen) return chosen;
    files.insert(files.begin() + 1, "functions.glsl");
    files.insert(files.end(), {"patch_exact_point.glsl", "patch_polar_taps.glsl"});
  } else {
    files.emplace_back("magnify.glsl");
  }
  files.emplace_back(kFiles[which]);
  return build(place, std::move(files), role, kind, extras);
}

}  // namespace terrella
