// What a scene keeps is told once, and follows the net and the patches it belongs to.
#include "scene/scene.hpp"
#include "knead/session/session_info.hpp"

#include <gtest/gtest.h>

#include "scene/model/model.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::on_sheet;
using testing::refusal;
using testing::run;
using testing::same_bits;

TEST(Scene, MirrorImageOfAPointForcePullsOnItsOwnPatch) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[10,10],"net":[10,10]})", R"({"do":"edge"})",
                R"({"do":"new","size":[10,10],"net":[10,10],"position":[20,0,0]})",
                R"({"do":"edge"})", R"({"do":"symmetry","mirror":"u"})",
                R"({"do":"force","at":[0.25,0.5],"to":[22.5,5,5],"strength":20})",
                R"({"do":"select","surfaces":["#1","#2"]})", R"({"do":"step"})"});
  const SceneSurface &other = session.state().surfaces[0], &pulled = session.state().surfaces[1];
  EXPECT_TRUE(same_bits(*other.current, *other.opened));
  const double height = at(*pulled.current, 0.25, 0.5).z();
  EXPECT_GT(height, 0.1);
  EXPECT_NEAR(at(*pulled.current, 0.75, 0.5).z(), height, 1e-9 * height);
}

TEST(Scene, MirrorImageOfAPointForcePullsAsOnASurfaceAlone) {
  const std::vector<std::string> pulled = {
      R"({"do":"edge"})", R"({"do":"symmetry","mirror":"u"})",
      R"({"do":"force","at":[0.25,0.5],"to":[22.5,5,5],"strength":20})"};
  const std::string sheet = R"({"do":"new","size":[10,10],"net":[10,10],"position":[20,0,0]})";
  Session alone = fresh(), second = fresh();
  run(alone, {sheet});
  run(alone, pulled);
  run(alone, {R"({"do":"step"})"});
  run(second, {R"({"do":"new","size":[10,10],"net":[10,10]})", R"({"do":"edge"})", sheet});
  run(second, pulled);
  run(second, {R"({"do":"select","surfaces":["#1","#2"]})", R"({"do":"step"})"});
  EXPECT_LE((first(alone).current->control_points() -
             second.state().surfaces[1].current->control_points())
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
}

/// A sheet that swings upwards.
Session swinging() {
  return on_sheet({R"({"do":"evolve","mode":"dynamic","time_step":0.05})", testing::lift,
                   R"({"do":"step","count":3})"});
}

Surface velocity_of(const Session& session) {
  return *first(session).current->with_control_points(first(session).velocity);
}

TEST(Scene, VelocityFollowsRefinement) {
  for (const char* finer : {R"({"do":"refine","region":[[0.2,0.6],[0,1]]})", R"({"do":"elevate"})",
                            R"({"do":"refine","knots_v":[0.3]})"}) {
    Session session = swinging();
    const Surface before = velocity_of(session);
    run(session, {finer});
    ASSERT_EQ(first(session).velocity.rows(), first(session).current->size()) << finer;
    const Surface after = velocity_of(session);
    double fastest = 0;
    for (double s : {0.1, 0.25, 0.5, 0.55, 0.9}) {
      for (double t : {0.2, 0.5, 0.7}) {
        EXPECT_LE((at(after, s, t) - at(before, s, t)).norm(), 1e-13) << finer;
        fastest = std::max(fastest, at(before, s, t).norm());
      }
    }
    EXPECT_GT(fastest, 0.01);
  }
}

TEST(Scene, SwingingGoesOnOverARefinement) {
  Session plain = swinging(), refined = swinging();
  run(refined, {R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"step"})"});
  run(plain, {R"({"do":"step"})"});
  const double kinetic = plain.state().steps.back().kinetic;
  EXPECT_NEAR(refined.state().steps.back().kinetic, kinetic, 0.05 * kinetic);
}

TEST(Scene, CoarseningSaysThatTheSurfaceStops) {
  Session session = swinging();
  run(session,
      {R"({"do":"refine","region":[[0,1],[0,1]]})", R"({"do":"coarsen","tolerance":0.01})"});
  EXPECT_EQ(first(session).velocity.rows(), 0);
  EXPECT_NE(session.state().notes.back().find("at rest"), std::string::npos)
      << session.state().notes.back();
}

TEST(Scene, EqualInputsAreWhatAModelDependsOn) {
  Session session = on_sheet({testing::ball});
  const ModelInput before = model_input(session.state(), session.state().evolution);
  run(session, {R"({"do":"move","by":[1,0,0]})", R"({"do":"load","pressure":1})",
                R"({"do":"limit","distance":3})", R"({"do":"force","at":[0.5,0.5],"to":[0,0,1]})"});
  EXPECT_EQ(model_input(session.state(), session.state().evolution), before);
  for (const char* other :
       {R"({"do":"hold","rows":1})", R"({"do":"pin","control_points":[[4,4]]})",
        R"({"do":"seams","couple":false})", R"({"do":"evolve","lambda":2})",
        R"({"do":"material","mass":3})", R"({"do":"smooth","poles":false})",
        R"({"do":"scaling","mode":"raw"})", R"({"do":"tool","radius":0.5,"position":[5,5,9]})",
        R"({"do":"keep","u":0.5})", R"({"do":"edge","which":"u0","hold":"open"})"}) {
    run(session, {other});
    EXPECT_NE(model_input(session.state(), session.state().evolution), before) << other;
    run(session, {R"({"do":"undo"})"});
  }
}

/// A scene for each kind of model, every one displaced.
std::vector<SessionState> one_of_each_kind() {
  const std::vector<std::vector<std::string>> scripts = {
      {R"({"do":"new","size":[10,10],"net":[8,8]})", R"({"do":"hold","rows":1})",
       R"({"do":"force","at":[0.5,0.5],"to":[5,5,3]})", R"({"do":"step"})"},
      {R"({"do":"new","size":[10,10],"net":[8,8]})", R"({"do":"hold","rows":1})",
       R"({"do":"material","model":"shell","young":1000,"thickness":0.1})",
       R"({"do":"force","at":[0.5,0.5],"to":[5,5,3]})", R"({"do":"step"})"},
      {R"({"do":"new","shape":"curve","size":[10],"net":[8]})", R"({"do":"edge"})",
       R"({"do":"force","at":[0.5],"to":[5,5,3]})", R"({"do":"step"})"},
      {R"({"do":"new","shape":"volume","net":[4,4,4]})", R"({"do":"edge","which":"w0"})",
       R"({"do":"material","model":"fundamental","w1":1})",
       R"({"do":"force","at":[0.5,0.5,1],"to":[0,0,3]})", R"({"do":"step"})"}};
  std::vector<SessionState> scenes;
  for (const auto& script : scripts) {
    Session session = fresh();
    run(session, script);
    EXPECT_GT(*session.energy(), 0) << script.front();
    scenes.push_back(session.state());
  }
  return scenes;
}

TEST(Model, ServesItsSceneAndEvolutionAlone) {
  const std::vector<SessionState> scenes = one_of_each_kind();
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const auto model = model_of(scenes[k], scenes[k].evolution);
    ASSERT_TRUE(model) << model.error().message();
    EXPECT_EQ((*model)->size(), active_state(scenes[k]).control_points.rows());
    EvolutionPolicy other = scenes[k].evolution;
    other.lambda *= 2;
    EXPECT_FALSE((*model)->serves(scenes[k], other)) << k;
    for (std::size_t l = 0; l < scenes.size(); ++l) {
      EXPECT_EQ((*model)->serves(scenes[l], scenes[k].evolution), k == l) << k << ", " << l;
      EXPECT_EQ((*model)->measures(scenes[l]), k == l) << k << ", " << l;
    }
  }
}

TEST(Model, StepsAndMeasuresAsItsSession) {
  for (const SessionState& scene : one_of_each_kind()) {
    auto model = model_of(scene, scene.evolution);
    ASSERT_TRUE(model) << model.error().message();
    const auto loads = (*model)->loads(scene);
    ASSERT_TRUE(loads) << loads.error().message();
    EXPECT_EQ(loads->points.size(), 1u);
    const ActiveState now = active_state(scene);
    const auto step = (*model)->step(now, scene.tools, *loads);
    ASSERT_TRUE(step) << step.error().message();
    constexpr double rounded = 1e-12;  // coordinates, in which linear models do not count
    EXPECT_NEAR((*model)->energy({step->control_points, now.rest}), step->energy,
                rounded * step->energy);
    const double before = scene.steps.back().energy;
    EXPECT_NEAR((*model)->energy(now), before, rounded * before);
  }
}

TEST(Models, KeepTheLastFewAndMakeNoneAgain) {
  const std::vector<SessionState> scenes = one_of_each_kind();
  Models models;
  EXPECT_EQ(models.last(), nullptr);
  const auto model_for = [&](std::size_t k) { return *models.of(scenes[k], scenes[k].evolution); };
  const Model* const first = model_for(0);
  EXPECT_EQ(model_for(0), first);
  const Model* const second = model_for(1);
  EXPECT_NE(second, first);
  EXPECT_EQ(model_for(0), first);
  EXPECT_EQ(models.last(), first);
  static_cast<void>(model_for(2));
  EXPECT_EQ(models.measuring(scenes[1]), second);
  static_cast<void>(model_for(3));
  EXPECT_EQ(models.measuring(scenes[1]), nullptr);
  EXPECT_EQ(models.measuring(scenes[0]), first);
}

TEST(Measure, TellsWhereASurfacePointIs) {
  Session session =
      on_sheet({R"({"do":"measure","name":"tip","at":[0.5,0.25]})", testing::lift,
                R"({"do":"step","count":3})", R"({"do":"refine","region":[[0,0.5],[0,1]]})"});
  ASSERT_EQ(session.state().probes.size(), 1U);
  const auto reading = read_probe(session.state(), session.state().probes.front());
  ASSERT_TRUE(reading) << reading.error().message();
  EXPECT_LE((reading->point - at(*first(session).current, 0.5, 0.25)).norm(), 1e-14);
  EXPECT_LE((reading->point - reading->displacement - Point(5, 2.5, 0)).norm(), 1e-14);
  EXPECT_GT(reading->displacement.z(), 0.05);
  EXPECT_NEAR(reading->normal.norm(), 1, 1e-15);
  EXPECT_LE(std::abs(reading->normal.x()), 1e-9);  // half way in u the sheet is level in u
  EXPECT_LT(reading->normal.y(), -1e-3);           // and rises in v
  run(session, {R"({"do":"measure","name":"tip","at":[0,0]})",
                R"({"do":"measure","name":"other","at":[1,1]})"});
  ASSERT_EQ(session.state().probes.size(), 2U);
  EXPECT_EQ(session.state().probes.front(), (Probe{"measurements", "tip", 0, {0, 0}}));
  EXPECT_EQ(refusal(session, R"({"do":"measure","at":[0.5,2]})").where, "at");
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->state().probes, session.state().probes);
  run(session, {R"({"do":"remove","measurement":"tip"})"});
  ASSERT_EQ(session.state().probes.size(), 1U);
  EXPECT_EQ(session.state().probes.front().name, "other");
  EXPECT_EQ(refusal(session, R"({"do":"remove","measurement":"tip"})").where, "measurement");
  EXPECT_EQ(refusal(session, R"({"do":"remove","measurement":"other","tool":"ball"})").where,
            "measurement");
}

TEST(Measure, TellsHowTheSurfaceBends) {
  Session session = Session(Document::fresh("round"));
  run(session, {R"({"do":"new","shape":"cylinder","radius":3,"height":5})",
                R"({"do":"new","shape":"sphere","radius":2})",
                R"({"do":"measure","name":"wall","surface":"#1","at":[0.3,0.4]})",
                R"({"do":"measure","name":"ball","surface":"#2","at":[0.3,0.4]})",
                R"({"do":"measure","name":"pole","surface":"#2","at":[0.3,0]})"});
  const auto& probes = session.state().probes;
  ASSERT_EQ(probes.size(), 3U);
  const auto curvature = [&](std::size_t k) {
    return read_probe(session.state(), probes[k])->curvature;
  };
  ASSERT_TRUE(curvature(0) && curvature(1));
  EXPECT_NEAR((*curvature(0))[0], 0, 1e-13);
  EXPECT_NEAR((*curvature(0))[1], -1.0 / 3, 1e-13);
  EXPECT_NEAR((*curvature(1))[0], -0.5, 1e-13);
  EXPECT_NEAR((*curvature(1))[1], -0.5, 1e-13);
  EXPECT_FALSE(curvature(2));
  EXPECT_EQ(refusal(session, R"({"do":"measure","surface":"#7"})").where, "surface");
  const auto reading = reading_json(session, 1, {0.3, 0.4});
  ASSERT_TRUE(reading);
  EXPECT_NE(reading->find("\"curvature\":[-0."), std::string::npos) << *reading;
  EXPECT_NE(session_json(session).find("\"name\":\"wall\""), std::string::npos);
}

}  // namespace
}  // namespace knead
