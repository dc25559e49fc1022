#pragma once

#include <cstdint>

#include "patient/body/spine.h"
#include "patient/solid/body_part.h"

/** The body's organs and bones, in the order in which they are drawn. Each function appends its parts to the plan.
 * Where a dimension has no source in its file, it was chosen by eye from radiographs. */
namespace endovascular_sim::patient
{

/** Skin, subcutaneous fat, muscle (torso.cpp). */
void addTorso(BodyPlan& plan);

/** Lungs with vessels, diaphragm, trachea and bronchi (lungs.cpp). */
void addLungs(BodyPlan& plan, std::uint64_t seed);

/** Heart, great vessels, mediastinum (heart.cpp). */
void addHeart(BodyPlan& plan);

/** Liver, kidneys, psoas muscles, gas of stomach and bowel (abdomen.cpp). */
void addAbdomen(BodyPlan& plan, const SpineCurve& spine, std::uint64_t seed);

/** Vertebrae C6 to L5 (spine.cpp). */
void addVertebrae(BodyPlan& plan, const SpineCurve& spine);

/** Ribs, costal cartilage, sternum (rib_cage.cpp). */
void addRibCage(BodyPlan& plan, const SpineCurve& spine);

/** Clavicles, scapulae, heads of the humeri (shoulder_girdle.cpp). */
void addShoulderGirdle(BodyPlan& plan);

/** Sacrum, coccyx, hip bones (pelvis.cpp). */
void addPelvis(BodyPlan& plan);

/** Proximal femurs (femurs.cpp). */
void addFemurs(BodyPlan& plan);

}  // namespace endovascular_sim::patient
