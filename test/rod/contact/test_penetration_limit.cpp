#include "rod/contact/penetration_limit.h"

#include <gtest/gtest.h>

#include "test/rod/rod_fixtures.h"

namespace endovascular_sim::rod
{
namespace
{

constexpr double kRadius = 0.18e-3;
constexpr double kTolerated = 80e-6;  // m

class PenetrationLimitOfAWire : public testing::Test
{
protected:
  /** Contacts at nodes 3 and 9. */
  static ContactList pressedIn(double at_three, double at_nine)
  {
    ContactList contacts;
    contacts.set.features.resize(2);
    contacts.set.features[0].edge = 3;
    contacts.set.features[0].gap = -at_three;
    contacts.set.features[1].edge = 9;
    contacts.set.features[1].gap = -at_nine;
    return contacts;
  }

  const Discretisation rod_ = discretiseUniformly(uniformWire(0.1, 5e-5, kRadius, 7900.0), 21);
  PenetrationLimit limit_{rod_};
};

TEST_F(PenetrationLimitOfAWire, ToleratesTheEarlierDepthOfANodeAtThatNodeOnly)
{
  limit_.store(pressedIn(1.2 * kTolerated, 0.0), -1, 0.0);
  EXPECT_FALSE(limit_.isExceeded(pressedIn(1.2 * kTolerated, 0.9 * kTolerated)));
  EXPECT_TRUE(limit_.isExceeded(pressedIn(1.2 * kTolerated, 1.1 * kTolerated)));
  EXPECT_FALSE(limit_.isExceeded(pressedIn(1.1 * kTolerated, 0.0)));
  EXPECT_TRUE(limit_.isExceeded(pressedIn(1.3 * kTolerated, 0.0)));
}

TEST_F(PenetrationLimitOfAWire, IsFourFifthsOfTheRadiusOfAThinWire)
{
  const Discretisation thin = discretiseUniformly(uniformWire(0.1, 5e-5, 50e-6, 7900.0), 21);
  PenetrationLimit limit(thin);
  limit.store(ContactList(), -1, 0.0);
  EXPECT_FALSE(limit.isExceeded(pressedIn(39e-6, 0.0)));
  EXPECT_TRUE(limit.isExceeded(pressedIn(41e-6, 0.0)));
}

TEST_F(PenetrationLimitOfAWire, DoesNotApplyToASoftWallButToItsStiffLayer)
{
  limit_.store(ContactList(), -1, 0.0);
  ContactList contacts = pressedIn(0.17e-3, 0.0);
  contacts.set.features[0].stiffness = 1e5;
  EXPECT_FALSE(limit_.isExceeded(contacts));
  contacts.set.features[0].id = -1;
  contacts.set.features[0].gap = -73e-6;  // the axis lies 90 µm behind the layer
  EXPECT_TRUE(limit_.isExceeded(contacts));
}

TEST_F(PenetrationLimitOfAWire, IgnoresRetainedContacts)
{
  limit_.store(ContactList(), -1, 0.0);
  ContactList contacts = pressedIn(0.0, 2.0 * kTolerated);
  EXPECT_TRUE(limit_.isExceeded(contacts));
  contacts.retained = 1;
  EXPECT_FALSE(limit_.isExceeded(contacts));
}

TEST_F(PenetrationLimitOfAWire, CountsAContactInTheMouthForItsFirstNodeOnly)
{
  ContactList contacts = pressedIn(1.5 * kTolerated, 0.0);
  contacts.set.features[0].parameter = 0.3;
  ContactList next = pressedIn(0.0, 0.0);
  next.set.features[0].edge = 4;
  next.set.features[0].gap = -1.4 * kTolerated;
  limit_.store(contacts, -1, 0.0);
  EXPECT_FALSE(limit_.isExceeded(next));
  limit_.store(contacts, 3, 0.5);
  EXPECT_TRUE(limit_.isExceeded(next));
  EXPECT_FALSE(limit_.isExceeded(contacts));
}

}  // namespace
}  // namespace endovascular_sim::rod
