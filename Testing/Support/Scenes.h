// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Scenes.h
 * @brief   the scenes of random tests, and the simplest scene that fails
 *
 * Four environment variables control all random tests:
 *
 * - SPLATTINGMIP_TEST_SEED=n (default 0): other random numbers for each n. A test must pass for
 *   any n.
 * - SPLATTINGMIP_TEST_SCENES=p (default 25): p percent of each series' scenes, at least one.
 * - SPLATTINGMIP_TEST_SCENE=SERIES/NUMBER: this scene alone. A check that fails prints the name.
 * - SPLATTINGMIP_TEST_CHOICES="n n n ...": this scene draws these choices.
 *
 * The first scene that fails is run again with simpler choices as long as the same check fails.
 * Then what is left is described, with what runs it alone.
 */
#ifndef reference_Scenes_h
#define reference_Scenes_h

#include "Random.h"

#include <functional>
#include <string>

namespace reference
{

/**
 * The scene of SPLATTINGMIP_TEST_SCENE, empty if all are run. What counts over all scenes of a
 * series ("enough of them are cut") is checked only if it is empty.
 */
const std::string& onlyScene();

/**
 * What to say of a failed check, so that its scene can be run alone; empty between scenes.
 */
std::string howToRepeat();

/**
 * How many scenes have been run.
 */
int scenesRun();

/**
 * How many of a series' scenes are run: SPLATTINGMIP_TEST_SCENES percent of them, at least one.
 */
int scenesOf(int count);

/**
 * Prints one of the first failures, and counts it. While simpler scenes are looked for, keeps it.
 */
void reportFailure(const std::string& message);
int failures();

/**
 * A scene: draws from the random numbers, and reports what fails.
 */
using Scene = std::function<void(Random& random)>;

/**
 * The first failure of a scene that draws these choices; empty if there is none. Failures are not
 * reported. The tape has what it has drawn.
 */
std::string firstFailure(const Scene& scene, const Choices& choices, Tape& tape);

/**
 * Simpler choices for which the same check fails: zeros in place of others, fewer of them, smaller
 * ones.
 * @param runs  of the scene at most
 */
Choices simplestFailure(const Scene& scene, Choices choices, int runs);

/**
 * Calls body(number, random) for each scene of a series. A scene's random numbers depend on the
 * series' name and the scene's number alone, so that each can be run by itself.
 */
void forScenes(
  const std::string& series, int count, const std::function<void(int number, Random&)>& body);
}

#endif
