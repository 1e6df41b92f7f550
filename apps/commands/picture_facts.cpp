#include "apps/commands/picture_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/open_scene/open_picture.h"
#include "apps/process/option_names.h"
#include "geo/body.h"
#include "streaming/cut.h"
#include "streaming/georeference/figure.h"
#include "streaming/georeference/warp_extent.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

Result<PictureFacts> measure(const std::filesystem::path& picture, const DescribedBand& band) {
  PictureFacts facts;
  const auto file = measure_picture(picture);
  if (!file) return file.error();
  facts.file = *file;
  if (const auto rows = open_rows(picture)) facts.orientation = (*rows)->info().orientation;
  if (!file->raster) return facts;
  facts.is_numbers = band.band > 0 || holds_numbers(*file->raster);
  const auto raster = describe_raster(*file->raster, band, true);
  if (!raster) return raster.error();
  facts.raster = *raster;
  return facts;
}

Result<PictureFacts> measure(const RemotePicture& tiff, const DescribedBand& band, bool with_values) {
  PictureFacts facts;
  facts.file = tiff.picture;
  facts.is_numbers = band.band > 0 || holds_numbers(*tiff.picture.raster);
  auto raster = describe_raster(*tiff.picture.raster, band, with_values);
  if (!raster) {
    const std::string fault = tiff.file->take_fault();
    return fault.empty() ? raster.error() : Error{fault};
  }
  facts.raster = *std::move(raster);
  return facts;
}

std::string words_text(const PlaceWords& words) {
  std::string text;
  if (!words.crs.empty()) text += " --crs " + shell_word(words.crs);
  if (const auto& b = words.bounds) {
    text += fmt::format(" --bounds{}{:.15g},{:.15g},{:.15g},{:.15g}", b->west < 0 ? "=" : " ", b->west, b->south,
                        b->east, b->north);
  }
  if (words.west_deg) text += fmt::format(" --west{}{:.15g}", *words.west_deg < 0 ? "=" : " ", *words.west_deg);
  return text;
}

/// Tests with the cutter whether the picture is accepted, on the body that the picture states.
void try_out(PictureFacts& facts, const RemotePicture* tiff) {
  CutOptions cut;
  cut.images = {facts.file.path};
  cut.picture = facts.file;
  if (facts.crs) cut.body = stated_body(*facts.crs);
  set_place(cut, facts.words);
  if (facts.is_numbers) cut.numbers = CutNumbers{};
  if (tiff != nullptr) set_raster(cut, *tiff);
  const std::string body = cut.body.empty() ? std::string() : " --body " + cut.body;
  const std::string name = shell_word(facts.file.path.string()) + body + words_text(facts.words);
  facts.command = fmt::format("terrella view {}", name);
  Status can = check_pictures(cut);
  if (can && tiff != nullptr) can = check_shows_at_once(*tiff);
  if (!can) facts.refused = with_option_names(can.error().message);
  if (auto place = find_place(cut, facts.file)) facts.place = *std::move(place);
}

/// Distance between two near places: of arc, or as the numbers of longitude and latitude differ.
double apart_deg(const CrsPoint& p, const CrsPoint& q, bool of_arc) {
  const double shrink = of_arc ? std::cos(0.5 * (p.y + q.y) * M_PI / 180.0) : 1.0;
  return std::hypot(std::remainder(q.x - p.x, 360.0) * shrink, q.y - p.y);
}

/// Bounds in degrees and the size of a pixel, by PROJ.
void locate(PictureFacts& facts, const CrsPlace& at) {
  const auto crs = Crs::open(at.crs);
  if (!crs) return;
  facts.transform = at.to_crs;
  if (!facts.bounds_deg) {
    Georeference said;
    said.transform = at.to_crs;
    if (const auto extent = warp_extent(facts.file, said, *crs)) {
      facts.bounds_deg = CrsBounds{extent->west_deg, extent->south_deg, extent->east_deg, extent->north_deg};
    }
  }
  const double x = std::floor(0.5 * static_cast<double>(facts.file.width_px));
  const double y = std::floor(0.5 * static_cast<double>(facts.file.height_px));
  const auto corners = crs->places({at.to_crs.at(x, y), at.to_crs.at(x + 1.0, y), at.to_crs.at(x, y + 1.0)});
  if (!corners || !std::isfinite((*corners)[0].x)) return;
  const auto wide = [&](bool of_arc) { return apart_deg((*corners)[0], (*corners)[1], of_arc); };
  const auto high = [&](bool of_arc) { return apart_deg((*corners)[0], (*corners)[2], of_arc); };
  const bool of_arc = !crs->facts().geographic;
  const double degree_m = (facts.crs ? facts.crs->a_m : earth().ellipsoid.a_m()) * M_PI / 180.0;
  facts.pixel = PixelSize{of_arc, wide(of_arc), high(of_arc), wide(true) * degree_m, high(true) * degree_m};
}

/// Adds the known facts about the place.
Result<PictureFacts> place(Result<PictureFacts> facts, const PlaceWords& words) {
  if (!facts) return facts;
  facts->words = words;
  if (auto said = read_georeference(facts->file, words.crs.empty())) facts->said = *std::move(said);
  const std::string crs_text = !words.crs.empty() || !facts->said ? words.crs : facts->said->crs;
  if (!crs_text.empty()) {
    if (const auto crs = Crs::open(crs_text)) facts->crs = crs->facts();
  }
  if (const auto placed = place_picture(facts->file, words)) {
    for (const std::string& remark : placed->remarks) facts->remarks.push_back(with_option_names(remark));
    if (const auto& at = placed->placement) {
      facts->bounds_deg =
          CrsBounds{at->west_deg, at->north_deg - static_cast<double>(facts->file.height_px) * at->pixel_height_deg,
                    at->west_deg + static_cast<double>(facts->file.width_px) * at->pixel_width_deg, at->north_deg};
    }
    if (placed->projected) locate(*facts, *placed->projected);
  }
  return facts;
}

/// Adds how the picture is shown. `tiff`: null for a file.
Result<PictureFacts> tried(Result<PictureFacts> facts, const RemotePicture* tiff) {
  if (facts) try_out(*facts, tiff);
  return facts;
}

}  // namespace

Result<PictureFacts> look_at(const std::filesystem::path& picture, const PlaceWords& words, const DescribedBand& band) {
  return tried(place(measure(picture, band), words), nullptr);
}

Result<PictureFacts> look_at(const RemotePicture& tiff, const PlaceWords& words, const DescribedBand& band) {
  return tried(place(measure(tiff, band, static_cast<bool>(check_shows_at_once(tiff))), words), &tiff);
}

Result<PictureFacts> look_at_place(const RemotePicture& tiff, const PlaceWords& words, const DescribedBand& band) {
  return place(measure(tiff, band, false), words);
}

CrsBounds own_bounds(const PictureFacts& facts) {
  const auto width = static_cast<double>(facts.file.width_px), height = static_cast<double>(facts.file.height_px);
  const Affine& t = *facts.transform;
  const std::array corners = {t.at(0, 0), t.at(width, 0), t.at(0, height), t.at(width, height)};
  CrsBounds b{corners[0].x, corners[0].y, corners[0].x, corners[0].y};
  for (const CrsPoint& p : corners) {
    b = {std::min(b.west, p.x), std::min(b.south, p.y), std::max(b.east, p.x), std::max(b.north, p.y)};
  }
  return b;
}

}  // namespace terrella
