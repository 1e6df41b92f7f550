#include "view/color_map.h"

#include <algorithm>
#include <charconv>

namespace terrella {
namespace {

// Tables of evenly spaced colours, six hexadecimal digits each.

/// S. van der Walt, N. Smith, 2015; CC0 (BIDS/colormap, as in matplotlib).
constexpr std::string_view kViridis =
    "44015444025645045745055946075a46085c460a5d460b5e470d60470e6147106347116447136548146748166848176948186a481a6c481b6d"
    "481c6e481d6f481f70482071482173482374482475482576482677482878482979472a7a472c7a472d7b472e7c472f7d46307e46327e46337f"
    "463480453581453781453882443983443a83443b84433d84433e85423f854240864241864142874144874045884046883f47883f48893e4989"
    "3e4a893e4c8a3d4d8a3d4e8a3c4f8a3c508b3b518b3b528b3a538b3a548c39558c39568c38588c38598c375a8c375b8d365c8d365d8d355e8d"
    "355f8d34608d34618d33628d33638d32648e32658e31668e31678e31688e30698e306a8e2f6b8e2f6c8e2e6d8e2e6e8e2e6f8e2d708e2d718e"
    "2c718e2c728e2c738e2b748e2b758e2a768e2a778e2a788e29798e297a8e297b8e287c8e287d8e277e8e277f8e27808e26818e26828e26828e"
    "25838e25848e25858e24868e24878e23888e23898e238a8d228b8d228c8d228d8d218e8d218f8d21908d21918c20928c20928c20938c1f948c"
    "1f958b1f968b1f978b1f988b1f998a1f9a8a1e9b8a1e9c891e9d891f9e891f9f881fa0881fa1881fa1871fa28720a38620a48621a58521a685"
    "22a78522a88423a98324aa8325ab8225ac8226ad8127ad8128ae8029af7f2ab07f2cb17e2db27d2eb37c2fb47c31b57b32b67a34b67935b779"
    "37b87838b9773aba763bbb753dbc743fbc7340bd7242be7144bf7046c06f48c16e4ac16d4cc26c4ec36b50c46a52c56954c56856c66758c765"
    "5ac8645cc8635ec96260ca6063cb5f65cb5e67cc5c69cd5b6ccd5a6ece5870cf5773d05675d05477d1537ad1517cd2507fd34e81d34d84d44b"
    "86d54989d5488bd6468ed64590d74393d74195d84098d83e9bd93c9dd93ba0da39a2da37a5db36a8db34aadc32addc30b0dd2fb2dd2db5de2b"
    "b8de29bade28bddf26c0df25c2df23c5e021c8e020cae11fcde11dd0e11cd2e21bd5e21ad8e219dae319dde318dfe318e2e418e5e419e7e419"
    "eae51aece51befe51cf1e51df4e61ef6e620f8e621fbe723fde725";

/// S. van der Walt, N. Smith, 2015; CC0 (BIDS/colormap, as in matplotlib).
constexpr std::string_view kMagma =
    "00000401000501010601010802010902020b02020d03030f03031204041405041606051806051a07061c08071e0907200a08220b09240c0926"
    "0d0a290e0b2b100b2d110c2f120d31130d34140e36150e38160f3b180f3d19103f1a10421c10441d11471e114920114b21114e221150241253"
    "25125527125829115a2a115c2c115f2d11612f116331116533106734106936106b38106c390f6e3b0f703d0f713f0f72400f74420f75440f76"
    "4510774710784910784a10794c117a4e117b4f127b51127c52137c54137d56147d57157e59157e5a167e5c167f5d177f5f187f601880621980"
    "641a80651a80671b80681c816a1c816b1d816d1d816e1e81701f81721f817320817521817621817822817922827b23827c23827e2482802582"
    "8125818326818426818627818827818928818b29818c29818e2a81902a81912b81932b80942c80962c80982d80992d809b2e7f9c2e7f9e2f7f"
    "a02f7fa1307ea3307ea5317ea6317da8327daa337dab337cad347cae347bb0357bb2357bb3367ab5367ab73779b83779ba3878bc3978bd3977"
    "bf3a77c03a76c23b75c43c75c53c74c73d73c83e73ca3e72cc3f71cd4071cf4070d0416fd2426fd3436ed5446dd6456cd8456cd9466bdb476a"
    "dc4869de4968df4a68e04c67e24d66e34e65e44f64e55064e75263e85362e95462ea5661eb5760ec5860ed5a5fee5b5eef5d5ef05f5ef1605d"
    "f2625df2645cf3655cf4675cf4695cf56b5cf66c5cf66e5cf7705cf7725cf8745cf8765cf9785df9795df97b5dfa7d5efa7f5efa815ffb835f"
    "fb8560fb8761fc8961fc8a62fc8c63fc8e64fc9065fd9266fd9467fd9668fd9869fd9a6afd9b6bfe9d6cfe9f6dfea16efea36ffea571fea772"
    "fea973feaa74feac76feae77feb078feb27afeb47bfeb67cfeb77efeb97ffebb81febd82febf84fec185fec287fec488fec68afec88cfeca8d"
    "fecc8ffecd90fecf92fed194fed395fed597fed799fed89afdda9cfddc9efddea0fde0a1fde2a3fde3a5fde5a7fde7a9fde9aafdebacfcecae"
    "fceeb0fcf0b2fcf2b4fcf4b6fcf6b8fcf7b9fcf9bbfcfbbdfcfdbf";

/// J. Nuñez, C. Anderton, R. Renslow, PLoS ONE 13(7), 2018, e0199239; CC0 (as in matplotlib).
constexpr std::string_view kCividis =
    "00224e00234f00245100255300255400265600275800285900285b00295d002a5f002a61002b62002c64002c66002d68002e6a002e6c002f6d"
    "00306f0030700031700031710132710533710833700c34700f357012357014367016377018376f1a386f1c396f1e3a6f203a6f213b6e233c6e"
    "243c6e263d6e273e6e293f6e2a3f6d2b406d2d416d2e416d2f426d31436d32436d33446d34456c35456c36466c38476c39486c3a486c3b496c"
    "3c4a6c3d4a6c3e4b6c3f4c6c404c6c414d6c424e6c434e6c444f6c45506c46516c47516c48526c49536c4a536c4b546c4c556c4d556c4e566c"
    "4f576c50576c51586d52596d535a6d545a6d555b6d555c6d565c6d575d6d585e6d595e6e5a5f6e5b606e5c616e5d616e5e626e5e636f5f636f"
    "60646f61656f62656f636670646770656870656870666970676a71686a71696b716a6c716b6d726c6d726c6e726d6f726e6f736f7073707173"
    "7172747272747273747374757474757575757676767777767777777878777979777a7a787b7a787c7b787d7c787e7c787e7d787f7e78807f78"
    "817f788280798381798482798582798683798784788885788985788a86788b87788c88788d88788e89788f8a78908b78918b78928c78928d78"
    "938e78948e77958f779690779791779892779992779a93769b94769c95769d95769e96769f9775a09875a19975a29975a39a74a49b74a59c74"
    "a69c74a79d73a89e73a99f73aaa073aba072aca172ada272aea371afa471b0a571b1a570b3a670b4a76fb5a86fb6a96fb7a96eb8aa6eb9ab6d"
    "baac6dbbad6dbcae6cbdae6cbeaf6bbfb06bc0b16ac1b26ac2b369c3b369c4b468c5b568c6b667c7b767c8b866c9b965cbb965ccba64cdbb63"
    "cebc63cfbd62d0be62d1bf61d2c060d3c05fd4c15fd5c25ed6c35dd7c45cd9c55cdac65bdbc75adcc859ddc858dec958dfca57e0cb56e1cc55"
    "e2cd54e4ce53e5cf52e6d051e7d150e8d24fe9d34eead34cebd44bedd54aeed649efd748f0d846f1d945f2da44f3db42f5dc41f6dd3ff7de3e"
    "f8df3cf9e03afbe138fce236fde334fee434fee535fee636fee838";

/// Computed by the method of K. Moreland, "Diverging color maps for scientific visualization", 2009: cool to warm.
constexpr std::string_view kDiverging =
    "3b4cc0445acc4e68d75875e16282ea6c8ef1779af782a5fb8db0fe98b9ffa3c2feaec9fdb8d0f9c2d5f4ccd9eed5dbe6dddddde5d8d1ecd3c6"
    "f1ccb9f5c4adf7bba0f7b194f7a687f49a7bf18d6fec7f63e57057de614cd55042cb3e38c0282fb40426";

constexpr std::string_view kGrey = "000000ffffff";

/// Drawn for Terrella: sea from deep to shallow up to position 0.5, land from the shore to snow from there on.
constexpr std::array<ColorStop, 12> kTerrain = {{{0.0, {8, 26, 74}},
                                                 {0.2, {20, 62, 124}},
                                                 {0.38, {50, 110, 170}},
                                                 {0.48, {112, 172, 212}},
                                                 {0.5, {176, 216, 232}},
                                                 {0.5, {62, 120, 66}},
                                                 {0.55, {122, 160, 84}},
                                                 {0.62, {200, 196, 124}},
                                                 {0.72, {184, 146, 92}},
                                                 {0.84, {130, 94, 70}},
                                                 {0.94, {196, 188, 184}},
                                                 {1.0, {255, 255, 255}}}};

// Round the compass from north: blue, green, yellow, red. Ground that faces north-west, from where maps are lit, and
// ground that faces south-east differ the most in brightness.
constexpr std::array<ColorStop, 9> kAspect = {{{0.0, {96, 168, 240}},
                                               {0.125, {64, 152, 152}},
                                               {0.25, {48, 128, 64}},
                                               {0.375, {104, 104, 40}},
                                               {0.5, {168, 72, 40}},
                                               {0.625, {216, 104, 72}},
                                               {0.75, {248, 184, 88}},
                                               {0.875, {224, 224, 200}},
                                               {1.0, {96, 168, 240}}}};

constexpr std::array<std::string_view, 6> kNames = {"viridis", "magma", "cividis", "grey", "terrain", "diverging"};
constexpr std::array<std::string_view, 6> kTables = {kViridis, kMagma, kCividis, kGrey, {}, kDiverging};

std::uint8_t byte_of(std::string_view digits) {
  unsigned value = 0;
  std::from_chars(digits.data(), digits.data() + 2, value, 16);
  return static_cast<std::uint8_t>(value);
}

ColorMap evenly_spaced(std::string_view table) {
  ColorMap map;
  const std::size_t colors = table.size() / 6;
  for (std::size_t k = 0; k < colors; ++k) {
    const std::string_view color = table.substr(6 * k);
    map.stops.push_back({static_cast<double>(k) / static_cast<double>(colors - 1),
                         {byte_of(color), byte_of(color.substr(2)), byte_of(color.substr(4))}});
  }
  return map;
}

}  // namespace

std::span<const std::string_view> color_map_names() { return kNames; }

std::optional<ColorMap> named_color_map(std::string_view name) {
  if (name == "aspect") return ColorMap{.stops = {kAspect.begin(), kAspect.end()}};
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  const std::string_view table = kTables[static_cast<std::size_t>(found - kNames.begin())];
  if (!table.empty()) return evenly_spaced(table);
  return ColorMap{.stops = {kTerrain.begin(), kTerrain.end()}};
}

}  // namespace terrella
