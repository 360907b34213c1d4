#include "math/student.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "math/statistics.h"

namespace midway {
namespace {

// Abramowitz and Stegun 1964, table 26.10; two-sided chances.
TEST(Student, LimitsAreThoseOfTheTables) {
    struct Row {
        double freedom, alpha, t;
    };
    for (const Row& r :
         {Row{1, 0.05, 12.706}, Row{2, 0.05, 4.303}, Row{3, 0.05, 3.182}, Row{7, 0.05, 2.365},
          Row{7, 0.001, 5.408}, Row{30, 0.05, 2.042}, Row{120, 0.01, 2.617}, Row{4, 0.1, 2.132}}) {
        SCOPED_TRACE(r.freedom);
        EXPECT_NEAR(student_limit(r.alpha, r.freedom), r.t, 6e-4);
        EXPECT_NEAR(student_two_sided_p(r.t, r.freedom), r.alpha, 6e-4 * r.alpha * r.freedom);
    }
}

TEST(Student, HasClosedFormsForOneAndTwoDegreesOfFreedom) {
    for (const double t : {1e-6, 0.3, 1.0, 7.0, 1e3, 1e8}) {
        SCOPED_TRACE(t);
        const double one = 2 / std::acos(-1.0) * std::atan2(1, t);
        EXPECT_NEAR(student_two_sided_p(t, 1) / one, 1, 1e-12);
        const double two = 2 / (2 + t * t) / (1 + t / std::sqrt(2 + t * t));
        EXPECT_NEAR(student_two_sided_p(t, 2) / two, 1, 1e-12);
    }
}

TEST(Student, NearsTheNormalDistribution) {
    for (const double t : {-3.0, -0.5, 0.0, 1.0, 5.0})
        EXPECT_NEAR(normal_deviate_of_student(t, 1e9), t, 1e-6 * (1 + t * t));
    EXPECT_NEAR(normal_limit(0.05), 1.959964, 1e-6);
    // Few degrees of freedom make the same t less surprising; the sign stays.
    EXPECT_LT(normal_deviate_of_student(5, 3), 3);
    EXPECT_GT(normal_deviate_of_student(-5, 3), -3);
    EXPECT_TRUE(std::isfinite(normal_deviate_of_student(1e300, 50)));
}

TEST(Student, IntervalsNeedTwoNumbers) {
    const std::array<double, 3> v{1, 2, 6};
    const MeanInterval m = mean_interval(v);
    EXPECT_DOUBLE_EQ(m.mean, 3);
    // s^2 = 7, t(2) = 4.303.
    EXPECT_NEAR(m.upper - m.mean, 4.303 * std::sqrt(7.0 / 3), 2e-3);
    EXPECT_TRUE(std::isnan(mean_interval({v.data(), 1}).upper));
    EXPECT_THROW(student_two_sided_p(1, 0), std::invalid_argument);
    EXPECT_THROW(student_limit(1.5, 3), std::invalid_argument);
}

}  // namespace
}  // namespace midway
