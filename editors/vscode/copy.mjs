// What the package takes from the rest of the project as it is there: the configuration's schema, the licence.
import { copyFileSync, mkdirSync } from "node:fs";

mkdirSync("schemas", { recursive: true });
copyFileSync("../../robosc/schemas/controller-config.schema.json", "schemas/controller-config.schema.json");
copyFileSync("../../LICENSE", "LICENSE");
