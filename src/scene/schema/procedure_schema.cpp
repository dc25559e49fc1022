#include <algorithm>
#include <cmath>
#include <limits>

#include "common/units.h"
#include "fluoroscopy/gantry/view.h"
#include "scene/schema/scene_schema.h"

// Schema of the procedure of a scripted operator.

namespace endovascular_sim::scene
{
namespace
{

// Keys of the actions, in the order of StepAction.
const std::vector<std::string> kActions = {"advance", "withdraw", "rotate", "inflate", "exchange", "wait", "inject"};
const std::vector<std::string> kBreaths = {"hold", "free"};
const std::vector<std::string> kHeartPhases = {"diastole"};

void visitGoal(yaml::Fields& fields, GoalScene& goal)
{
  if (fields.reading() || !goal.tip_in.empty())
    fields.text("tip_in", goal.tip_in);
  if (fields.reading() || !goal.balloon_in.empty())
    fields.text("balloon_in", goal.balloon_in);
  if (fields.reading() || !goal.tip_in.empty() || !goal.balloon_in.empty())
    fields.optionalNumber("beyond", goal.beyond, quantities::kInsertion, Range::any());
  fields.boolean("outside", goal.outside);
  fields.optionalNumber("insertion", goal.insertion, quantities::kInsertion, Range::any());
  fields.optionalNumber("by", goal.by, quantities::kInsertion, Range::positive());
  fields.optionalNumber("turned", goal.turned, quantities::kRotation, Range::any());
  fields.number("held", goal.held, quantities::kWait, Range::nonNegative());
  if (!fields.reading())
    return;
  if (!goal.tip_in.empty() && !goal.balloon_in.empty())
    fields.reject("balloon_in", "conflicts with tip_in; keep one of the two");
  if (fields.has("beyond") && goal.tip_in.empty() && goal.balloon_in.empty())
    fields.reject("beyond", "requires a branch; give tip_in or balloon_in, or remove it");
}

bool isEmpty(const GoalScene& goal)
{
  return goal.tip_in.empty() && goal.balloon_in.empty() && !goal.outside && std::isnan(goal.insertion) &&
         std::isnan(goal.by) && std::isnan(goal.turned);
}

void visitRetry(yaml::Fields& fields, StepScene& step)
{
  RetryScene& retry = step.retry;
  fields.number("back", retry.back, quantities::kInsertion, Range::nonNegative());
  fields.number("turn", retry.turn, quantities::kRotation, Range::any());
  fields.integer("times", retry.times, 0, 1000);
  fields.optionalNumber("deepest", retry.deepest, quantities::kInsertion, Range::positive());
  if (fields.has("deepest") && step.action != StepAction::kAdvance)
    fields.reject("deepest", "applies to advance only; remove it");
  if (fields.has("deepest") && retry.deepest <= step.until.insertion)
    fields.reject("deepest", "is not deeper than until.insertion; give a larger value, or remove it");
}

void visitSupport(yaml::Fields& fields, SupportScene& support)
{
  fields.text("instrument", support.instrument, Need::kRequired);
  fields.text("tip_in", support.tip_in, Need::kRequired);
  fields.text("again_from", support.again_from, Need::kRequired);
  fields.integer("times", support.times, 0, 1000);
}

/** Visits the key that names the action of a step and its instrument. */
void visitAction(yaml::Fields& fields, StepScene& step)
{
  if (fields.reading())
  {
    int found = -1;
    for (std::size_t k = 0; k < kActions.size(); ++k)
    {
      if (!fields.has(kActions[k]))
        continue;
      if (found >= 0)
        fields.reject(kActions[k], "conflicts with " + kActions[static_cast<std::size_t>(found)] +
                                       "; a step has one action, split it into two");
      found = static_cast<int>(k);
    }
    if (found < 0)
      fields.reject("", "has no action; give one of advance, withdraw, rotate, inflate, exchange, wait, inject");
    step.action = static_cast<StepAction>(found);
  }
  const std::string& key = kActions[static_cast<std::size_t>(step.action)];
  if (step.action == StepAction::kWait)
    fields.number(key, step.duration, quantities::kWait, Range::nonNegative(), Need::kRequired);
  else
    fields.text(key, step.instrument, Need::kRequired);
}

/** Visits what a wait asks of the patient. */
void visitWait(yaml::Fields& fields, StepScene& step)
{
  if (fields.reading() ? fields.has("hyperaemia") : step.hyperaemia.has_value())
  {
    if (!step.hyperaemia)
      step.hyperaemia.emplace();
    fields.boolean("hyperaemia", *step.hyperaemia);
  }
  if (fields.reading() ? fields.has("breath") : step.breath_held.has_value())
  {
    int word = step.breath_held.value_or(true) ? 0 : 1;
    fields.choice("breath", word, kBreaths);
    step.breath_held = word == 0;
  }
  if (fields.reading() ? fields.has("until") : step.until_diastole)
  {
    int word = 0;
    fields.choice("until", word, kHeartPhases);
    step.until_diastole = true;
  }
}

void visitStep(yaml::Fields& fields, StepScene& step)
{
  if (fields.reading() || !step.phase.empty())
    fields.text("phase", step.phase);
  if (fields.reading() || !step.hint.empty())
    fields.text("hint", step.hint);
  if (fields.reading() || !step.view.empty())
    fields.text("view", step.view);
  if (fields.reading() && !step.view.empty() && !fluoroscopy::parseView(step.view))
    fields.reject("view", fluoroscopy::unknownView(step.view));
  visitAction(fields, step);
  if (step.action == StepAction::kWait)
  {
    visitWait(fields, step);
    return;
  }
  if (step.action == StepAction::kInflate)
  {
    fields.number("pressure", step.pressure, quantities::kPressure,
                  {-units::kAtmosphere, std::numeric_limits<double>::max()}, Need::kRequired);
    fields.number("for", step.duration, quantities::kWait, Range::nonNegative(), Need::kRequired);
    return;
  }
  if (step.action == StepAction::kInject)
  {
    visitInjection(fields, step.volume, step.rate, step.rise);
    return;
  }
  if (step.action == StepAction::kExchange)
    fields.text("for", step.replacement, Need::kRequired);
  fields.map("until", [&step](yaml::Fields& goal) { visitGoal(goal, step.until); });
  if (fields.reading() && isEmpty(step.until))
    fields.reject("until", "missing; give the goal of the step, e.g. until: {tip_in: aortic_arch}");
  if (step.action != StepAction::kRotate)
    fields.number("speed", step.speed, quantities::kSpeed, Range::positive());
  else if (fields.reading())
    step.turn_speed = 1.0;
  fields.number("turn_speed", step.turn_speed, quantities::kAngularSpeed, Range::any());
  fields.boolean("steer", step.steer);
  if (fields.reading() && step.steer && (step.action != StepAction::kAdvance || step.until.tip_in.empty()))
    fields.reject("steer", "needs advance with until.tip_in: the tip is turned along the path to that branch");
  fields.number("time_limit", step.time_limit, quantities::kDuration, Range::positive());
  fields.boolean("any_branch", step.any_branch);
  fields.map("retry", [&step](yaml::Fields& retry) { visitRetry(retry, step); });
  if (fields.reading() ? fields.has("support") : !step.support.instrument.empty())
    fields.map("support", [&step](yaml::Fields& support) { visitSupport(support, step.support); });
}

void visitHand(yaml::Fields& fields, HandScene& hand)
{
  fields.number("max_speed", hand.max_speed, quantities::kSpeed, Range::positive());
  fields.number("max_turn", hand.max_turn, quantities::kAngularSpeed, Range::positive());
  fields.number("acceleration", hand.acceleration, quantities::kAcceleration, Range::positive());
  fields.number("turn_acceleration", hand.turn_acceleration, quantities::kAngularAcceleration, Range::positive());
  fields.number("reaction", hand.reaction, quantities::kReaction, Range::positive());
  fields.number("push_force", hand.push_force, quantities::kHandForce, Range::positive());
  fields.number("pull_force", hand.pull_force, quantities::kHandForce, Range::positive());
  fields.number("patience", hand.patience, quantities::kWait, Range::positive());
  fields.number("speed_scale", hand.speed_scale, quantities::kSpeedScale, Range::positive());
}

void visitPassMarks(yaml::Fields& fields, PassMarks& pass)
{
  fields.optionalNumber("time", pass.time, quantities::kDuration, Range::positive());
  fields.optionalNumber("wall_force", pass.wall_force, quantities::kWallForce, Range::positive());
  fields.optionalNumber("hand_force", pass.hand_force, quantities::kHandForce, Range::positive());
  fields.optionalNumber("wrong_branches", pass.wrong_branches, quantities::kCount, Range::nonNegative());
  fields.optionalNumber("errors", pass.errors, quantities::kCount, Range::nonNegative());
  fields.optionalNumber("stenosis", pass.stenosis, quantities::kFraction, Range::nonNegative());
}

bool hasMarks(const PassMarks& pass)
{
  for (const double mark :
       {pass.time, pass.wall_force, pass.hand_force, pass.wrong_branches, pass.errors, pass.stenosis})
    if (!std::isnan(mark))
      return true;
  return false;
}

/** Instrument of this name if the procedure, or in a lesson a person, drives it, otherwise null. */
const DrivenInstrument* scripted(const Scene& scene, const std::string& instrument)
{
  const bool guided = scene.procedure->guided;
  for (const DrivenInstrument& driven : scene.instruments)
    if (driven.instrument.name == instrument && driven.drive.source != DriveSource::kScript &&
        (guided ? driven.drive.source != DriveSource::kProcedure : driven.drive.source == DriveSource::kProcedure))
      return &driven;
  return nullptr;
}

void checkSupport(const yaml::Fields& fields, const Scene& scene, std::size_t k)
{
  const std::vector<StepScene>& steps = scene.procedure->steps;
  const SupportScene& support = steps[k].support;
  if (support.instrument.empty())
    return;
  const std::string path = "procedure.steps." + std::to_string(k) + ".support.";
  if (steps[k].action != StepAction::kAdvance)
    fields.reject(path + "instrument", "applies to advance only; remove it");
  // Instruments are listed from the inside out, so the supporting one must come later.
  const auto named = [](const std::string& name)
  { return [&name](const DrivenInstrument& driven) { return driven.instrument.name == name; }; };
  const auto inner = std::find_if(scene.instruments.begin(), scene.instruments.end(), named(steps[k].instrument));
  if (std::none_of(inner + 1, scene.instruments.end(), named(support.instrument)))
    fields.reject(path + "instrument", "'" + support.instrument + "' is not outside '" + steps[k].instrument +
                                           "'; name an instrument that the scene lists after it");
  const auto end = steps.begin() + static_cast<std::ptrdiff_t>(k + 1);
  if (std::none_of(steps.begin(), end, [&support](const StepScene& step) { return step.phase == support.again_from; }))
    fields.reject(path + "again_from",
                  "no step so far has the phase '" + support.again_from + "'; name an earlier phase");
}

/** Rejects a step with an injection that is impossible in the scene. */
void checkInjection(const yaml::Fields& fields, const Scene& scene, const std::string& path, const StepScene& step)
{
  if (step.action != StepAction::kInject)
    return;
  if (!scene.contrast)
    fields.reject(path + "inject", "needs contrast medium; give the scene the key contrast, e.g. contrast: {}");
  if (step.instrument != scene.contrast->instrument)
    fields.reject(path + "inject", "'" + step.instrument + "' does not inject; name '" + scene.contrast->instrument +
                                       "', or set contrast.instrument");
  const contrast::Injection injection = scene.contrast->injection(step.volume, step.rate, step.rise);
  if (const std::string refusal = refusalOf(injection, scene.contrast->syringe()); !refusal.empty())
    rejectInjection(fields, path, refusal);
}

}  // namespace

void visitProcedure(yaml::Fields& fields, ProcedureScene& procedure)
{
  if (fields.reading() || !procedure.name.empty())
    fields.text("name", procedure.name);
  if (fields.reading() || procedure.guided)
    fields.boolean("guided", procedure.guided);
  if (fields.reading() || hasMarks(procedure.pass))
    fields.map("pass", [&procedure](yaml::Fields& pass) { visitPassMarks(pass, procedure.pass); });
  fields.map("hand", [&procedure](yaml::Fields& hand) { visitHand(hand, procedure.hand); });
  if (fields.reading() || !procedure.branches.empty())
    fields.list(
        "branches", procedure.branches.size(), [&procedure](std::size_t size) { procedure.branches.resize(size); },
        [&procedure](yaml::Fields& branch, std::size_t k)
        {
          branch.text("name", procedure.branches[k].name, Need::kRequired);
          branch.vector3("at", procedure.branches[k].at, quantities::kPosition, Need::kRequired);
        });
  fields.list(
      "steps", procedure.steps.size(), [&procedure](std::size_t size) { procedure.steps.resize(size); },
      [&procedure](yaml::Fields& step, std::size_t k) { visitStep(step, procedure.steps[k]); }, Need::kRequired);
}

void checkProcedure(const yaml::Fields& fields, const Scene& scene)
{
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    if (scene.instruments[k].drive.source == DriveSource::kProcedure && !scene.procedure)
      fields.reject(drivePath(scene, k) + "drive.source",
                    "is procedure, but the scene has no procedure; give procedure: FILE, or another source");
  if (!scene.procedure)
    return;
  if (!scene.vessel)
    fields.reject("procedure", "requires a vessel, because its goals are branches");
  for (std::size_t k = 0; k < scene.procedure->steps.size(); ++k)
  {
    const StepScene& step = scene.procedure->steps[k];
    const std::string path = "procedure.steps." + std::to_string(k) + ".";
    const std::string remedy = scene.procedure->guided
                                   ? "' is not driven by a person; name an instrument of the scene and set its "
                                     "drive.source: topic, or procedure.guided: false"
                                   : "' is not driven by the procedure; name an instrument of the scene and set its "
                                     "drive.source: procedure";
    const bool moves = step.action != StepAction::kWait && step.action != StepAction::kInject;
    if (moves && scripted(scene, step.instrument) == nullptr)
      fields.reject(path + kActions[static_cast<std::size_t>(step.action)], "'" + step.instrument + remedy);
    if (step.action == StepAction::kInflate && !scripted(scene, step.instrument)->instrument.balloon)
      fields.reject(path + "inflate", "'" + step.instrument + "' has no balloon; name a balloon catheter");
    if (step.action == StepAction::kExchange && scripted(scene, step.replacement) == nullptr)
      fields.reject(path + "for", "'" + step.replacement + remedy);
    if (step.hyperaemia && !scene.flow)
      fields.reject(path + "hyperaemia", "needs blood that flows; give the scene the key flow, e.g. flow: adult");
    checkInjection(fields, scene, path, step);
    checkSupport(fields, scene, k);
    if (!step.view.empty())
      checkView(fields, path + "view", step.view, scene);
  }
}

}  // namespace endovascular_sim::scene
