// The air of a picture against rays that are marched in double (air_truth.h), at the horizon and over the ground.
#include <gtest/gtest.h>

#include <cstdio>

#include "air_fixture.h"

namespace terrella::test {
namespace {

TEST_F(AirPictures, AreThoseOfMarchedRays) {
  Sum all;
  int views = 0;
  for (const char* name : {"earth", "mars", "titan"}) {
    const Body body = *parse_body(name);
    const AirTruth truth(*atmosphere_of(body), body.ellipsoid);
    const auto globe = globe_with_air(body, 0);
    for (const AirView& v : air_views(body.ellipsoid)) {
      globe->set_camera(camera(v));
      settle(*globe, kSize);
      const Sum one = compare(truth, make_view(camera(v), body.ellipsoid, kSize), 0.0);
      EXPECT_LE(one.rms(), kOne_levels) << name << " from " << v.height_m << " m, Sun at " << v.sun_deg;
      all.squares += one.squares;
      all.count += one.count;
      ++views;
    }
  }
  EXPECT_GE(views, 40);
  EXPECT_LE(all.rms(), kAll_levels);
  RecordProperty("rms_levels", std::to_string(all.rms()));
  std::printf("RMS %.2f levels over %d views\n", all.rms(), views);
}

}  // namespace
}  // namespace terrella::test
