#pragma once

#include <vector>

#include "rod/contact/contact_list.h"
#include "rod/model/discretisation.h"
#include "rod/stepping/stepper.h"

namespace endovascular_sim::rod
{

/** Force law of contacts: a one-sided spring per feature, and the wall forces that the springs exert.
 *
 *  A rigid wall has the penalty stiffness. A compliant wall has its stiffness per length of wire, times the tributary
 *  length of the contact, times the contact's share among the facets that touch the same node. */
class ContactSprings
{
public:
  /** @param rod, settings must outlive this */
  ContactSprings(const Discretisation& rod, const StepperSettings& settings) : rod_(rod), settings_(settings) {}

  /** Sets one spring per feature of the list; active are those that the velocity would close within @p dt [s].
   *  @param wall motion of the wall in that time, with which the state moves already; null: it rests */
  void prepare(const State& state, double dt, ContactList& contacts, const contact::WallTravel* wall = nullptr);

  /** Collects the compliant contacts between nodes, in order along the wire; of retained ones those in compression.
   *  Tributary lengths refer to the last collection. */
  void collectCrossings(const State& state, const ContactList& contacts);

  /** Spring of one feature, inactive, without wall offset; after collectCrossings(). */
  ContactSpring springOf(const std::vector<contact::Feature>& features, int index) const;

  /** Sets the spring forces after the accepted motion of their solve, and from them the state's wall forces. */
  void exertForces(ContactList& contacts, const NodalMotion& motion, State& state) const;

private:
  double tributaryLength(const std::vector<contact::Feature>& features, int index) const;
  double lengthTowards(const std::vector<contact::Feature>& features, int index, int edge, double parameter,
                       int direction) const;
  static double shareAtNode(const std::vector<contact::Feature>& features, int index);

  const Discretisation& rod_;
  const StepperSettings& settings_;
  std::vector<int> crossings_;  ///< compliant contacts between nodes, in order along the wire
};

}  // namespace endovascular_sim::rod
