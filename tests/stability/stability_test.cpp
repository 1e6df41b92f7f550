// The self-test on this machine's OpenGL: what the README promises of accuracy holds here, or this fails.
#include <cmath>

#include "apps/bench/stability/check.h"
#include "tests/gl/gl_context_test.h"

namespace terrella::bench {
namespace {

class Stability : public test::GlContextTest {
 protected:
  void expect_passed(Status (*section)(const StabilityOptions&, Checks&), ShaderFunctions functions) {
    Checks checks;
    const Status done = section({.functions = functions, .quick = true}, checks);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_FALSE(checks.empty());
    for (const Check& check : checks) {
      EXPECT_TRUE(check.passed()) << check.test << ", " << check.subject << " at " << check.at << ' ' << check.at_unit
                                  << ": " << check.error << ' ' << check.unit << ", at most " << check.limit;
    }
  }
  void expect_passed(Status (*section)(const StabilityOptions&, Checks&)) {
    const Result<ShaderFunctions> chosen = choose_shader_functions();
    ASSERT_TRUE(chosen) << chosen.error().message;
    expect_passed(section, *chosen);
  }
};

TEST_F(Stability, OwnFunctionsAreGoodEnoughEverywhere) { expect_passed(check_functions, ShaderFunctions::own); }

TEST_F(Stability, TheFunctionsThatAreChosenAreGoodEnough) { expect_passed(check_functions); }

TEST_F(Stability, ReversedDepthTellsAMillionthOfTheDistanceApart) { expect_passed(check_depth); }

TEST_F(Stability, NoVertexJittersFromOneMetreToAMillionKilometres) { expect_passed(check_jitter); }

TEST_F(Stability, WindowPointsAreRightWithTheFunctionsThatAreChosen) { expect_passed(check_places); }

TEST_F(Stability, WindowPointsAreRightWithOwnFunctions) { expect_passed(check_places, ShaderFunctions::own); }

TEST_F(Stability, GeodeticConversionsAndPicksAreWhatGeographicLibSays) { expect_passed(check_geodesy); }

TEST_F(Stability, TheSameInputGivesTheSamePixels) { expect_passed(check_same_pixels); }

// A driver's function that is coarse, or gives what is no number, must be noticed.
TEST(ShaderFunctions, ThatAreCoarseAreNotGoodEnough) {
  EXPECT_TRUE(good_enough({}));
  for (double FunctionErrors::*member : {&FunctionErrors::atan, &FunctionErrors::sine, &FunctionErrors::cosine,
                                         &FunctionErrors::inversesqrt, &FunctionErrors::length}) {
    FunctionErrors errors;
    errors.*member = 1e-5;
    EXPECT_FALSE(good_enough(errors));
    errors.*member = HUGE_VAL;
    EXPECT_FALSE(good_enough(errors));
  }
}

}  // namespace
}  // namespace terrella::bench
