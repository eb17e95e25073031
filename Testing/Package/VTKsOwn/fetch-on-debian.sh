#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# fetch-on-debian.sh FOLDER
#
# Puts four of VTK's own tests into FOLDER, unless it exists. They come in no package but in the
# source of one, which anybody may fetch from where packages come from.
set -euo pipefail

folder=$1
[[ ! -d $folder ]] || exit 0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
  sed -n 's|^.*/debian/* .*|deb-src &|p' >"$scratch/sources.list"
mkdir -p "$scratch/lists/partial" "$scratch/cache/archives/partial" "$scratch/tests"
apt=(
  apt-get -qq
  -o "Dir::Etc::SourceList=$scratch/sources.list" -o Dir::Etc::SourceParts=-
  -o "Dir::State::Lists=$scratch/lists" -o "Dir::Cache=$scratch/cache"
  -o APT::Sandbox::User=root # which may write to the scratch folder
)
"${apt[@]}" update
(cd "$scratch" && "${apt[@]}" source --download-only vtk9)
tar -xf "$scratch"/vtk9_*.orig.tar.xz -C "$scratch/tests" --wildcards --transform 's|.*/||' \
  '*/TestGPURayCast*BlendModes.cxx' '*/TestGPURayCastCompositeToMIP.cxx' \
  '*/TestGPURayCastMIPToComposite.cxx'
mkdir -p "$(dirname "$folder")"
mv "$scratch/tests" "$folder"
