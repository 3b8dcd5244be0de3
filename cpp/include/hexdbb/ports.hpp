// Ports: the quantities of the mechanism that an effect can displace ("push"), and, in the same layout, the sensitivity
// of the reading to a push at each of them.
//
//   slider          6      mm, slider k is further along its guideway than it reports
//   leg             6      mm, leg k is longer
//   slider_joint    6 x 3  mm, centre of the joint on slider k is displaced, base frame
//   platform_joint  6 x 3  mm, ball joint of leg k on the platform is displaced, platform frame
//   ball            3      mm, centre ball of the bar is displaced, platform frame
//   cup             3      mm, tool cup is displaced, base frame
//   reading         1      mm, added to the reading
//
// One Ports is 55 consecutive numbers, so that a block of samples is a matrix with one column per port.
#pragma once

#include <array>

#include "hexdbb/types.hpp"

namespace hexdbb {

struct PortSpan {
  const char* name;
  int first;
  int size;
};

namespace port {
constexpr int kSlider = 0;
constexpr int kLeg = 6;
constexpr int kSliderJoint = 12;
constexpr int kPlatformJoint = 30;
constexpr int kBall = 48;
constexpr int kCup = 51;
constexpr int kReading = 54;
constexpr int kCount = 55;

constexpr std::array<PortSpan, 7> kSpans = {{{"slider", kSlider, 6},
                                             {"leg", kLeg, 6},
                                             {"slider_joint", kSliderJoint, 18},
                                             {"platform_joint", kPlatformJoint, 18},
                                             {"ball", kBall, 3},
                                             {"cup", kCup, 3},
                                             {"reading", kReading, 1}}};
}  // namespace port

struct Ports {
  Eigen::Matrix<double, port::kCount, 1> value = Eigen::Matrix<double, port::kCount, 1>::Zero();

  auto slider() { return value.segment<6>(port::kSlider); }
  auto slider() const { return value.segment<6>(port::kSlider); }
  auto leg() { return value.segment<6>(port::kLeg); }
  auto leg() const { return value.segment<6>(port::kLeg); }
  auto slider_joint(int leg_index) { return value.segment<3>(port::kSliderJoint + 3 * leg_index); }
  auto slider_joint(int leg_index) const { return value.segment<3>(port::kSliderJoint + 3 * leg_index); }
  auto platform_joint(int leg_index) { return value.segment<3>(port::kPlatformJoint + 3 * leg_index); }
  auto platform_joint(int leg_index) const { return value.segment<3>(port::kPlatformJoint + 3 * leg_index); }
  auto ball() { return value.segment<3>(port::kBall); }
  auto ball() const { return value.segment<3>(port::kBall); }
  auto cup() { return value.segment<3>(port::kCup); }
  auto cup() const { return value.segment<3>(port::kCup); }
  double& reading() { return value[port::kReading]; }
  double reading() const { return value[port::kReading]; }
};

}  // namespace hexdbb
