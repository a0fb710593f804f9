#!/bin/sh
# Makes `drive.fmu` and `controller.fmu` of their sources, with the C compiler and zip: ./build.sh
set -eu
cd "$(dirname "$0")"
for name in drive controller; do
    folder=$(mktemp -d)
    mkdir -p "$folder/binaries/linux64"
    cp "$name.xml" "$folder/modelDescription.xml"
    cc -O2 -shared -fPIC -ffp-contract=off -o "$folder/binaries/linux64/$name.so" "$name.c"
    rm -f "$name.fmu"
    (cd "$folder" && zip -qr "$OLDPWD/$name.fmu" .)
    rm -r "$folder"
done
