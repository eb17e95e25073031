#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# fetch-vtk.sh FOLDER
#
# Puts VTK's sources into FOLDER, unless it exists: those that Debian's packages of VTK are made from,
# without Debian's patches. They are downloaded from the addresses in the machine's apt sources. Needs
# root.
set -euo pipefail

folder=$1
[[ ! -d $folder ]] || exit 0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

apt-get update -qq # without lists there are no addresses
apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
  sed -n 's|^.*/debian/* .*|deb-src &|p' >"$scratch/sources.list"
mkdir -p "$scratch/lists/partial" "$scratch/cache/archives/partial"
apt=(
  apt-get -qq
  -o "Dir::Etc::SourceList=$scratch/sources.list" -o Dir::Etc::SourceParts=-
  -o "Dir::State::Lists=$scratch/lists" -o "Dir::Cache=$scratch/cache"
  -o APT::Sandbox::User=root # which may write to the scratch folder
)
"${apt[@]}" update
(cd "$scratch" && "${apt[@]}" source --download-only vtk9)
# What is unpacked only in part has another name.
rm -rf "$folder.part"
mkdir -p "$folder.part"
tar -xf "$scratch"/vtk9_*.orig.tar.xz -C "$folder.part" --strip-components=1
mv "$folder.part" "$folder"
