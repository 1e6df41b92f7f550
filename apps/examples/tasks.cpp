// tasks TILES OUTPUT.png: six tasks of a mapping application, each between a name in brackets and [end] (TASKS.md).
#include <epoxy/gl.h>
#include <terrella/geo/split_position.h>
#include <terrella/globe.h>
#include <terrella/render/caller_glsl.h>
#include <terrella/render/gl/offscreen.h>
#include <terrella/streaming/sets/open_tile_set.h>
#include <terrella/tiles/painted_tiles.h>

#include <fstream>
#include <iostream>

using namespace terrella;

namespace {

constexpr Viewport kSize{640, 360};
const Geodetic kHome{.lat = Angle::degrees(46), .lon = Angle::degrees(8)};
const Geodetic kAway{.lat = Angle::degrees(48), .lon = Angle::degrees(3)};
const Camera kOver{.eye = {.lat = Angle::degrees(46), .lon = Angle::degrees(8), .height_m = 1e7}};
constexpr ObjectId kAircraft{1};

GLuint linked(const std::string& vertex, const std::string& fragment) {
  const GLuint program = glCreateProgram();
  for (const auto& [type, text] : {std::pair{GL_VERTEX_SHADER, &vertex}, {GL_FRAGMENT_SHADER, &fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(type));
    const char* source = text->c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  return program;
}

/// Vertices of a triangle, 300 km high, that stands on the ground.
GLuint standing_triangle(const Ellipsoid& body) {
  std::vector<SplitPosition> corners;
  for (const auto& [east_deg, height_m] : {std::pair{-2.0, 0.0}, {2.0, 0.0}, {0.0, 3e5}}) {
    const Geodetic at{.lat = Angle::degrees(45), .lon = Angle::degrees(12 + east_deg), .height_m = height_m};
    corners.push_back(split_position(body.to_ecef(at).xyz_m));
  }
  GLuint buffer = 0, array = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferStorage(buffer, 3 * sizeof(SplitPosition), corners.data(), 0);
  glCreateVertexArrays(1, &array);
  glVertexArrayVertexBuffer(array, 0, buffer, 0, sizeof(SplitPosition));
  for (const GLuint k : {0U, 1U}) {
    glEnableVertexArrayAttrib(array, k);
    glVertexArrayAttribFormat(array, k, 3, GL_FLOAT, GL_FALSE, k * sizeof(glm::vec3));
    glVertexArrayAttribBinding(array, k, 0);
  }
  return array;
}

Status add_own_tiles(Globe& globe) {
  // [own tiles]
  const auto own = globe.add_imagery(painted_tiles({.tile_px = 256, .max_level = 10}, [](const TileId& id) {
    const auto alpha = static_cast<std::uint8_t>((id.x + id.y) % 2 == 0 ? 0 : 60);
    return Image{256, 256, std::vector<std::uint8_t>(std::size_t{256} * 256 * 4, alpha)};
  }));
  // [end]
  return own ? Status(Done{}) : own.error();
}

Status move_object(Globe& globe, LayerId fleet, const Geodetic& to) {
  // [move an object]
  return globe.edit_objects(fleet, {.moves = {{kAircraft, to}}});
  // [end]
}

std::string pick_properties(const Globe& globe, glm::dvec2 cursor_px, Viewport size) {
  std::string properties;
  // [pick to properties]
  const GlobePick under = globe.pick(cursor_px, size);
  if (under.object && under.object->of.feature) properties = under.object->of.feature->properties;
  // [end]
  return properties;
}

void draw_own(Globe& globe) {
  const GLuint triangle = standing_triangle(globe.options().body.ellipsoid);
  // [own drawing]
  const std::string head = "#version 450 core\n" + caller_glsl(globe.options().depth);
  const std::string vertex =
      "layout(location = 0) in vec3 high; layout(location = 1) in vec3 low;\n"
      "void main() { gl_Position = terrella_clip(terrella_from_eye(high, low)); }\n";
  const std::string fragment = "out vec4 color; void main() { color = vec4(1, 1, 0, 1); TERRELLA_WRITE_DEPTH; }\n";
  const GLuint program = linked(head + vertex, head + fragment);
  globe.on_draw([=](DrawStage stage, const FrameMatrices&) {
    if (stage != DrawStage::all) return;
    glUseProgram(program);
    glBindVertexArray(triangle);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  });
  // [end]
}

Status follow_terrain(Globe& globe, LayerId fleet, const Geodetic& place) {
  // [follow the terrain]
  const PointObject follower{.place = place, .of = {ObjectId{2}}, .heights = HeightMode::clamp_to_ground};
  return globe.edit_objects(fleet, {.add = {.points = {follower}}});
  // [end]
}

Status draw_map(Globe& globe, unsigned framebuffer, std::chrono::steady_clock::time_point deadline) {
  // [second view]
  const auto map = GlobeView::create(globe);
  if (!map) return map.error();
  (*map)->set_camera(kOver);
  (*map)->render_until_settled(framebuffer, {160, 90}, deadline);  // over the lower left corner
  // [end]
  return (*map)->status();
}

ObjectScene fleet_of() {
  const auto feature = std::make_shared<ObjectFeature>(ObjectFeature{.properties = R"({"name": "TE 1"})"});
  return {.points = {{.place = kAway, .size_px = 16.0F, .of = {.id = kAircraft, .feature = feature}}}};
}

Status do_tasks(const char* tiles, const char* output) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  auto source = open_tile_set(tiles);
  if (!source) return source.error();
  auto made = Globe::create({}, *std::move(source));
  if (!made) return made.error();
  Globe& globe = **made;
  globe.set_camera({.eye = {.lat = Angle::degrees(46), .lon = Angle::degrees(8), .height_m = 2e6}});
  const auto fleet = globe.add_objects(fleet_of());
  if (!fleet) return fleet.error();
  draw_own(globe);
  for (const Status& done :
       {add_own_tiles(globe), move_object(globe, *fleet, kHome), follow_terrain(globe, *fleet, kAway)}) {
    if (!done) return done;
  }

  const OffscreenTarget picture(kSize);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  if (!globe.render_until_settled(picture.framebuffer(), kSize, deadline)) return Error{"tiles are still coming"};
  if (Status drawn = draw_map(globe, picture.framebuffer(), deadline); !drawn) return drawn;
  std::cout << pick_properties(globe, {0.5 * kSize.width_px, 0.5 * kSize.height_px}, kSize) << '\n';
  const auto png = encode_png({kSize.width_px, kSize.height_px, picture.read()});
  if (!png) return png.error();
  std::ofstream file(output, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png->data()), std::ssize(*png));
  return file.flush() ? Status{Done{}} : Error{std::string(output) + ": cannot be written"};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "tasks TILES OUTPUT.png\n", 2;
  const Status done = do_tasks(argv[1], argv[2]);
  if (!done) std::cerr << done.error().message << '\n';
  return done ? 0 : 1;
}
