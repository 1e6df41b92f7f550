#include <string_view>

#include "render/gl/shader_library.h"
#include "render/surface/patch_pass.h"

// The programs of patches, made when first needed.
namespace terrella {
namespace {
/// #defines of LayerRole.
constexpr std::string_view kRoleDefines[] = {"BASE_LAYER", "UPPER_LAYER", "SPECIAL_LAYER"};
}  // namespace

Status PatchPass::prepare(LayerRole role, bool numbers, const std::vector<SelectedPatch>& patches) {
  ProgramSet& set = sets_[set_index(role, numbers, light_of(role, numbers))];
  const auto make = [&](int variant) -> Status {
    gl::Program& program = set.programs[variant];
    return program ? Status{Done{}} : make_program(program, variant, role, numbers);
  };
  for (const SelectedPatch& patch : patches) {
    if (Status made = make(variant_for(patch)); !made) return made;
    if (Status made = is_on_limb(patch) ? make(limb_variant_for(patch)) : Done{}; !made) return made;
  }
  return role == LayerRole::base ? Done{} : prepare_whole(Whole::black);
}

gl::Program& PatchPass::whole_program(Whole what, bool limb) {
  // The air before the ground is the same in every light; its vertices have slopes if those are lit.
  if (what == Whole::air) return sets_[set_index(LayerRole::base, false, {.relief = scene_.light.relief})].air;
  return what == Whole::depth ? depth_programs_[limb ? 1 : 0] : flat_programs_[limb ? 1 : 0];
}

Status PatchPass::prepare_whole(Whole what) {
  const std::string_view file = what == Whole::air     ? "patch_air.frag"
                                : what == Whole::depth ? "patch_depth.frag"
                                                       : "patch_flat.frag";
  for (const bool limb : {false, true}) {
    gl::Program& program = whole_program(what, limb);
    if (program || (limb && !scene_.limb)) continue;
    if (Status made = build(program, {"frame.glsl", "air.glsl", file}, LayerRole::base, false, {.limb = limb}); !made)
      return made;
  }
  return Done{};
}

Status PatchPass::build(gl::Program& place, std::initializer_list<std::string_view> fragment, LayerRole role,
                        bool numbers, const Extras& extras) const {
  const PatchLight light = light_of(role, numbers);
  return build_into(place,
                    {{GL_VERTEX_SHADER, {"frame.glsl", "regolith.glsl", "air_part.glsl", "patch.vert"}},
                     {GL_FRAGMENT_SHADER, fragment}},
                    {depth_define(options_.depth), light.relief ? "RELIEF" : "LEVEL_LIGHT",
                     options_.night_lights ? "DAY_AND_NIGHT" : "DAY_LIGHT", extras.pole ? "AT_POLE" : "OFF_POLE",
                     extras.city_lights ? "CITY_LIGHTS" : "NO_LAMPS", extras.limb ? "AT_LIMB" : "OFF_LIMB",
                     options_.regolith ? "REGOLITH" : "NO_DUST", light.glint ? "GLINT" : "NO_GLINT",
                     light.bicubic ? "BICUBIC" : "BILINEAR", scene_.air != nullptr ? "AIR" : "NO_AIR",
                     which() == 2 ? "NEAR_GROUND" : "FAR_FROM_GROUND",
                     functions_define(options_.functions.value_or(ShaderFunctions::driver)),
                     kRoleDefines[static_cast<int>(role)], numbers ? "NUMBERS" : "PICTURES"});
}

Status PatchPass::make_program(gl::Program& place, int variant, LayerRole role, bool numbers) {
  const int which = variant / 2;
  constexpr std::string_view kFiles[PatchLayer::kAll] = {
      "patch_magnified.frag",   "patch_plain.frag", "patch_long.frag",       "patch_oblique.frag",
      "patch_polar_short.frag", "patch_polar.frag", "patch_polar_long.frag", "patch_paper.frag",
      "patch_limb.frag",        "patch_limb.frag"};
  Extras extras{.city_lights = variant % 2 == 1, .limb = which >= PatchLayer::limb};
  extras.pole = extras.limb ? which == PatchLayer::polar_limb : which >= PatchLayer::polar_short;
  const std::string_view file = kFiles[which];
  if (!extras.pole) {
    return build(
        place,
        {"frame.glsl", "air.glsl", "patch_relief.glsl", "patch_common.glsl", "patch_taps.glsl", "magnify.glsl", file},
        role, numbers, extras);
  }
  if (!options_.functions) {  // coordinates are computed per fragment
    const Result<ShaderFunctions> chosen = choose_shader_functions();
    if (!chosen) return chosen.error();
    options_.functions = *chosen;
  }
  return build(place,
               {"frame.glsl", "functions.glsl", "air.glsl", "patch_relief.glsl", "patch_common.glsl", "patch_taps.glsl",
                "patch_exact_point.glsl", "patch_polar_taps.glsl", file},
               role, numbers, extras);
}

}  // namespace terrella
